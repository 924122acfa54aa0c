#include "panels/widgets.hpp"

#include "panels/style.hpp"

namespace deltalux::viewer {

namespace {
/// Shows what is pending instead of the value, keeps what the widget sets, and tells when the hand is off it.
template <class Widget>
Held held(Pending& pending, const char* label, std::array<float, 3>& value, Widget&& widget) {
  const ImGuiID id = ImGui::GetID(label);
  const std::array<float, 3> before = pending.id == id ? pending.start : value;
  if (pending.id == id) value = pending.value;
  const bool changed = widget(value.data());
  if (changed) pending = {id, value, before};
  if (pending.id != id) return Held::Nothing;
  if (ImGui::IsAnyItemActive()) return changed ? Held::Changed : Held::Nothing;
  pending.id = 0;
  return Held::Released;
}
}  // namespace

Held heldSlider(Pending& pending, const char* label, float& value, float least, float most, const char* format,
                ImGuiSliderFlags flags) {
  std::array<float, 3> v{value, 0, 0};
  const Held done =
      held(pending, label, v, [&](float* p) { return ImGui::SliderFloat(label, p, least, most, format, flags); });
  value = v[0];
  return done;
}

Held heldColour(Pending& pending, const char* label, Rgb& value, ImGuiColorEditFlags flags) {
  std::array<float, 3> v{value.r, value.g, value.b};
  const Held done = held(pending, label, v, [&](float* p) { return ImGui::ColorEdit3(label, p, flags); });
  value = {v[0], v[1], v[2]};
  return done;
}

bool heldNumbers(Pending& pending, const char* label, Vec3& value, const char* format) {
  const Vec3f before(value);
  std::array<float, 3> v{before.x, before.y, before.z};
  const bool done =
      held(pending, label, v, [&](float* p) { return ImGui::InputFloat3(label, p, format); }) == Held::Released;
  // What was not touched keeps the digits that single precision has not got.
  for (int i = 0; i < 3; ++i)
    if (v[std::size_t(i)] != before[i]) value[i] = double(v[std::size_t(i)]);
  return done;
}

bool slider(const char* label, double& value, double least, double most, const char* format, ImGuiSliderFlags flags) {
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &least, &most, format, flags);
}

void row(const std::string& what, const std::string& howMuch) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(what.c_str());
  ImGui::TableNextColumn();
  const float free = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(howMuch.c_str()).x;
  if (free > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + free);
  ImGui::TextUnformatted(howMuch.c_str());
}

void quietText(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ink::kQuiet);
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

}  // namespace deltalux::viewer
