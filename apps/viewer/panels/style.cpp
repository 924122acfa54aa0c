#include "panels/style.hpp"

#include <filesystem>

namespace deltalux::viewer {

namespace {
constexpr float kTextSize = 15;  // pixels at scale 1

/// Fonts that desktops have, the first of them that is there. ImGui's own is a bitmap of 13 pixels.
constexpr const char* kFonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                  "/usr/share/fonts/TTF/DejaVuSans.ttf",
                                  "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
                                  "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};

void loadFont(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  for (const char* file : kFonts)
    if (std::filesystem::exists(file) && io.Fonts->AddFontFromFileTTF(file, std::round(kTextSize * scale))) return;
  io.Fonts->AddFontDefault();
  io.FontGlobalScale = scale;
}
}  // namespace

void applyStyle(float scale) {
  ImGui::StyleColorsDark();
  loadFont(scale);
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0, style.FrameRounding = 3, style.GrabRounding = 3, style.PopupRounding = 3;
  style.WindowBorderSize = 0, style.FrameBorderSize = 0;
  style.WindowPadding = {10, 10}, style.FramePadding = {6, 3}, style.ItemSpacing = {7, 5};
  style.IndentSpacing = 14, style.ScrollbarSize = 12;
  style.ScaleAllSizes(scale);
  ImVec4* const c = style.Colors;
  const ImVec4 accent{0.36f, 0.47f, 0.60f, 1};
  c[ImGuiCol_WindowBg] = {0.105f, 0.11f, 0.12f, 1};
  c[ImGuiCol_PopupBg] = {0.13f, 0.135f, 0.15f, 0.98f};
  c[ImGuiCol_Text] = {0.87f, 0.88f, 0.89f, 1};
  c[ImGuiCol_TextDisabled] = {0.50f, 0.51f, 0.53f, 1};
  c[ImGuiCol_FrameBg] = {0.17f, 0.18f, 0.195f, 1};
  c[ImGuiCol_FrameBgHovered] = {0.22f, 0.23f, 0.25f, 1};
  c[ImGuiCol_FrameBgActive] = {0.25f, 0.27f, 0.30f, 1};
  c[ImGuiCol_Header] = {0.155f, 0.165f, 0.18f, 1};
  c[ImGuiCol_HeaderHovered] = {0.20f, 0.215f, 0.235f, 1};
  c[ImGuiCol_HeaderActive] = {0.23f, 0.25f, 0.28f, 1};
  c[ImGuiCol_Button] = {0.20f, 0.215f, 0.235f, 1};
  c[ImGuiCol_ButtonHovered] = {0.26f, 0.29f, 0.33f, 1};
  c[ImGuiCol_ButtonActive] = accent;
  c[ImGuiCol_SliderGrab] = accent, c[ImGuiCol_SliderGrabActive] = {0.46f, 0.58f, 0.72f, 1};
  c[ImGuiCol_CheckMark] = {0.66f, 0.78f, 0.92f, 1};
  c[ImGuiCol_PlotLines] = {0.66f, 0.78f, 0.92f, 1};
  c[ImGuiCol_PlotHistogram] = accent;
  c[ImGuiCol_Separator] = {0.22f, 0.23f, 0.25f, 1};
}

ImU32 axisColour(int axis, bool strong) {
  static const ImVec4 kAxes[3] = {
      {0.88f, 0.36f, 0.33f, 0.85f}, {0.45f, 0.74f, 0.38f, 0.85f}, {0.38f, 0.58f, 0.92f, 0.85f}};
  return ImGui::ColorConvertFloat4ToU32(strong ? ImVec4(1.0f, 0.86f, 0.35f, 1) : kAxes[axis]);
}

}  // namespace deltalux::viewer
