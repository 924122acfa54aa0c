#include <deltalux/error.hpp>

#include "export/sheet/pages.hpp"
#include "io/atomic_file.hpp"

namespace deltalux {

bool canWritePdf() { return exporting::makePdfCanvas("") != nullptr; }

void saveSheet(const std::filesystem::path& file, const Sheet& sheet) {
  const bool pdf = file.extension() == ".pdf";
  const std::unique_ptr<exporting::Canvas> canvas =
      pdf ? exporting::makePdfCanvas(sheet.request.title) : exporting::makeHtmlCanvas(sheet.request.title);
  if (!canvas)
    throw OutputError(file.string() +
                      ": this deltalux was built without Cairo, which writes PDF; write an .html instead");
  exporting::drawSheet(*canvas, sheet);
  io::writeFile(file, canvas->finish());
}

}  // namespace deltalux
