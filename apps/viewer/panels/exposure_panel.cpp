#include "panels/exposure_panel.hpp"

#include <imgui.h>

#include <algorithm>

#include "panels/widgets.hpp"

namespace deltalux::viewer {

namespace {
constexpr double kMostEv = 12;                   // of the slider [stops]; more can be typed
constexpr double kLeastTop = 1, kMostTop = 1e5;  // of the scale's upper end [lx or cd/m2]

void toneCombo(ToneMapping& tone) {
  const std::string now(toneOperatorName(tone.toneOperator));
  if (!ImGui::BeginCombo("tone", now.c_str())) return;
  for (const ToneOperator t : {ToneOperator::Linear, ToneOperator::Reinhard}) {
    const std::string name(toneOperatorName(t));
    if (ImGui::Selectable(name.c_str(), t == tone.toneOperator)) tone.toneOperator = t;
  }
  ImGui::EndCombo();
}

/// The steps, ascending and positive whatever was typed.
void bands(std::vector<double>& steps) {
  int gone = -1;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ImGui::PushID(int(i));
    ImGui::SetNextItemWidth(6 * ImGui::GetFontSize());
    ImGui::InputDouble("##step", &steps[i], 0, 0, "%.5g", ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::SmallButton("x")) gone = int(i);
    ImGui::PopID();
  }
  if (gone >= 0) steps.erase(steps.begin() + gone);
  if (ImGui::SmallButton("Add a step")) steps.push_back(steps.empty() ? 100 : 2 * steps.back());
  std::erase_if(steps, [](double s) { return !(s > 0); });
  std::sort(steps.begin(), steps.end());
}
}  // namespace

void exposurePanel(Controller& controller) {
  ToneMapping& tone = controller.draw().tone;
  slider("EV", tone.ev, -kMostEv, kMostEv, "%+.2f");
  if (ImGui::Button("Find it once (T)")) controller.automaticExposure();
  toneCombo(tone);
}

void falseColourPanel(Controller& controller) {
  FalseColour& f = controller.draw().falseColour;
  constexpr const char* kQuantities[] = {"Off", "Illuminance [lx]", "Luminance [cd/m\xc2\xb2]"};
  int quantity = int(f.quantity);
  if (ImGui::Combo("shows", &quantity, kQuantities, 3)) f.quantity = Quantity(quantity);
  if (f.quantity == Quantity::Radiance) return;
  ImGui::Checkbox("In steps", &f.useBands);
  ImGui::SameLine();
  ImGui::Checkbox("Isolines", &f.isolines);
  if (!f.useBands) {
    slider("up to", f.top, kLeastTop, kMostTop, "%.5g", ImGuiSliderFlags_Logarithmic);
    f.top = std::max(f.top, kLeastTop);
    ImGui::Checkbox("Logarithmic", &f.logarithmic);
    if (f.logarithmic) slider("decades", f.decades, 1, 6, "%.1f", ImGuiSliderFlags_AlwaysClamp);
  }
  if (f.useBands || f.isolines) bands(f.bands);
}

}  // namespace deltalux::viewer
