#include "panels/file_panel.hpp"

#include <imgui.h>

#include <deltalux/image_io.hpp>
#include <deltalux/output.hpp>

#include "panels/widgets.hpp"

namespace deltalux::viewer {

namespace {
/// A file's name and the button that saves it.
bool nameAndButton(const char* id, std::array<char, 256>& name, const char* button) {
  ImGui::PushID(id);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 8.5f * ImGui::GetFontSize());
  ImGui::InputText("##name", name.data(), name.size());
  ImGui::SameLine();
  const bool pressed = ImGui::Button(button, {-FLT_MIN, 0});
  ImGui::PopID();
  return pressed && name[0] != '\0';
}
}  // namespace

void FilePanel::tell(const std::string& text) {
  const std::scoped_lock lock(outcome_->mutex);
  outcome_->text = text;
}

void FilePanel::savePicture(Controller& controller, const gl::Renderer& renderer) {
  const std::filesystem::path file = picture_.data();
  const auto format = imageFormatOf(file);
  if (!format) {
    controller.lastError = "a picture is a .png, .exr or .hdr";
    return;
  }
  if (*format == ImageFormat::Png) {
    saveImage(file, renderer.screenshot());
  } else {
    Image radiance = renderer.radiance();
    radiance.luminousEfficacy = controller.scene().luminousEfficacy;
    radiance.view =
        viewOptions(fitted(controller.camera(), radiance.width, radiance.height), controller.scene().origin);
    saveImage(file, radiance);
  }
  tell(file.string() + " is written");
}

void FilePanel::saveSolution(Controller& controller) {
  const std::string file = solution_.data();
  checkWritable(file);
  tell(file + " is written once the light is settled");
  controller.solver().save(file, [outcome = outcome_, file](const std::string& wrong) {
    const std::scoped_lock lock(outcome->mutex);
    outcome->text = wrong.empty() ? file + " is written" : wrong;
  });
}

void FilePanel::saveSession(Controller& controller) {
  saveRecording(session_.data(), controller.session().recording());
  tell(std::string(session_.data()) + " is written");
}

void FilePanel::draw(Controller& controller, const gl::Renderer& renderer) {
  if (nameAndButton("picture", picture_, "Save picture"))
    attempt(controller, [&] { savePicture(controller, renderer); });
  if (nameAndButton("solution", solution_, "Save solution")) attempt(controller, [&] { saveSolution(controller); });
  if (nameAndButton("session", session_, "Save edits")) attempt(controller, [&] { saveSession(controller); });
  const std::scoped_lock lock(outcome_->mutex);
  if (!outcome_->text.empty()) quietText(outcome_->text);
}

}  // namespace deltalux::viewer
