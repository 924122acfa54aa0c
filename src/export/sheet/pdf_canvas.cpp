// Pages as PDF, by Cairo where the library was built with it.
#include "export/sheet/canvas.hpp"

#ifdef DELTALUX_CAIRO
#include <cairo-pdf.h>

#include <array>
#include <deltalux/error.hpp>
#endif

namespace deltalux::exporting {

#ifdef DELTALUX_CAIRO

namespace {

class PdfCanvas : public Canvas {
 public:
  explicit PdfCanvas(const std::string& title)
      : surface_(cairo_pdf_surface_create_for_stream(&PdfCanvas::take, &bytes_, kPageWidth, kPageHeight)),
        context_(cairo_create(surface_)) {
    cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_TITLE, title.c_str());
    cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_CREATOR, "deltalux " DELTALUX_VERSION);
  }
  ~PdfCanvas() override {
    cairo_destroy(context_);
    cairo_surface_destroy(surface_);
  }
  PdfCanvas(const PdfCanvas&) = delete;
  PdfCanvas& operator=(const PdfCanvas&) = delete;

  void beginPage() override {
    if (open_) cairo_show_page(context_);
    open_ = true;
  }
  void fill(const Vec2& at, const Vec2& size, const Ink& ink) override {
    use(ink);
    cairo_set_antialias(context_, CAIRO_ANTIALIAS_NONE);
    cairo_rectangle(context_, at.x, at.y, size.x, size.y);
    cairo_fill(context_);
    cairo_set_antialias(context_, CAIRO_ANTIALIAS_DEFAULT);
  }
  void path(std::span<const Vec2> points, bool closed, const Stroke& stroke) override {
    use(stroke.ink);
    cairo_new_path(context_);  // text leaves a point behind
    for (const Vec2& p : points) cairo_line_to(context_, p.x, p.y);
    if (closed) cairo_close_path(context_);
    const double dash[] = {4, 3};
    cairo_set_dash(context_, dash, stroke.dashed ? 2 : 0, 0);
    cairo_set_line_width(context_, stroke.width);
    cairo_stroke(context_);
  }
  void text(const Vec2& at, const std::string& text, const TextStyle& style) override {
    cairo_select_font_face(context_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context_, style.size);
    cairo_text_extents_t extents;
    cairo_text_extents(context_, text.c_str(), &extents);
    const double left = style.align == TextStyle::Align::Left     ? 0
                        : style.align == TextStyle::Align::Middle ? extents.x_advance / 2
                                                                  : extents.x_advance;
    if (style.halo) {
      use(kWhite);
      cairo_move_to(context_, at.x - left, at.y);
      cairo_text_path(context_, text.c_str());
      cairo_set_dash(context_, nullptr, 0, 0);
      cairo_set_line_width(context_, 2);
      cairo_stroke(context_);
    }
    use(style.ink);
    cairo_move_to(context_, at.x - left, at.y);
    cairo_show_text(context_, text.c_str());
  }
  void image(const Vec2& at, const Vec2& size, const DisplayImage& picture) override {
    cairo_surface_t* pixels = cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height);
    unsigned char* data = cairo_image_surface_get_data(pixels);
    const int stride = cairo_image_surface_get_stride(pixels);
    for (int y = 0; data && y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const auto& [r, g, b] = picture.at(x, y);
        const auto word = std::uint32_t(r) << 16 | std::uint32_t(g) << 8 | std::uint32_t(b);
        reinterpret_cast<std::uint32_t*>(data + std::ptrdiff_t(y) * stride)[x] = word;
      }
    cairo_surface_mark_dirty(pixels);
    cairo_save(context_);
    cairo_translate(context_, at.x, at.y);
    cairo_scale(context_, size.x / picture.width, size.y / picture.height);
    cairo_set_source_surface(context_, pixels, 0, 0);
    cairo_paint(context_);
    cairo_restore(context_);
    cairo_surface_destroy(pixels);
  }
  std::string finish() override {
    if (open_) cairo_show_page(context_);
    cairo_surface_finish(surface_);
    const cairo_status_t status = cairo_surface_status(surface_);
    if (status != CAIRO_STATUS_SUCCESS)
      throw OutputError(std::string("the PDF could not be made: ") + cairo_status_to_string(status));
    return std::move(bytes_);
  }

 private:
  static cairo_status_t take(void* bytes, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  }
  void use(const Ink& ink) { cairo_set_source_rgb(context_, ink.r, ink.g, ink.b); }

  std::string bytes_;
  cairo_surface_t* surface_;
  cairo_t* context_;
  bool open_ = false;
};

}  // namespace

std::unique_ptr<Canvas> makePdfCanvas(const std::string& title) { return std::make_unique<PdfCanvas>(title); }

#else

std::unique_ptr<Canvas> makePdfCanvas(const std::string&) { return nullptr; }

#endif

}  // namespace deltalux::exporting
