#include "window.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_opengl3.h>

#include <utility>

#include "gl/window_pixels.hpp"
#include "panels/style.hpp"
#include "viewer.hpp"

namespace deltalux::viewer {

namespace {
std::string glfwReason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "unknown reason";
}
}  // namespace

NoDisplay::NoDisplay(const std::string& missing)
    : std::runtime_error(fmt::format(
          "the viewer cannot open a window: {}\n"
          "It needs a display with OpenGL 3.3 (a remote or headless machine can have one: xvfb-run deltalux view "
          "...).\n"
          "Without one, these do the same: deltalux render (pictures of a view), deltalux update (applies edits),\n"
          "deltalux replay (a session, step by step), deltalux probe (illuminance at points).",
          missing)) {}

struct Window::Callbacks {
  static Window& of(GLFWwindow* w) { return *static_cast<Window*>(glfwGetWindowUserPointer(w)); }
  static void touched(GLFWwindow* w) { of(w).touched_ = true; }

  /// A letter's own code on this keyboard: GLFW's codes are places, with the letters of an American one.
  static int letter(int key, int scancode) {
    if (key < GLFW_KEY_A || key > GLFW_KEY_Z) return key;
    const char* name = glfwGetKeyName(key, scancode);
    const bool plain = name && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0';
    return plain ? GLFW_KEY_A + (name[0] - 'a') : key;
  }

  /// Before ImGui, which calls what was there before it.
  static void install(GLFWwindow* w) {
    glfwSetKeyCallback(w, [](GLFWwindow* window, int key, int scancode, int action, int modifiers) {
      touched(window);
      if (action == GLFW_PRESS && !ImGui::GetIO().WantTextInput)
        of(window).keys_.push_back({letter(key, scancode), modifiers});
    });
    glfwSetCharCallback(w, [](GLFWwindow* window, unsigned) { touched(window); });
    glfwSetMouseButtonCallback(w, [](GLFWwindow* window, int, int, int) { touched(window); });
    glfwSetScrollCallback(w, [](GLFWwindow* window, double, double) { touched(window); });
    glfwSetCursorPosCallback(w, [](GLFWwindow* window, double, double) { touched(window); });
    glfwSetCursorEnterCallback(w, [](GLFWwindow* window, int) { touched(window); });
    glfwSetWindowFocusCallback(w, [](GLFWwindow* window, int) { touched(window); });
    glfwSetWindowRefreshCallback(w, [](GLFWwindow* window) { touched(window); });
    glfwSetFramebufferSizeCallback(w, [](GLFWwindow* window, int, int) { touched(window); });
    glfwSetWindowCloseCallback(w, [](GLFWwindow* window) { touched(window); });
  }
};

Window::Window(const std::string& title, int width, int height, bool visible) {
  glfwSetErrorCallback(nullptr);
  if (glfwInit() != GLFW_TRUE) throw NoDisplay("there is no display (" + glfwReason() + ")");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!window_) {
    const std::string reason = glfwReason();
    glfwTerminate();
    throw NoDisplay("OpenGL 3.3 is missing (" + reason + ")");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  Callbacks::install(window_);
  float vertical = 1;
  glfwGetWindowContentScale(window_, &scale_, &vertical);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // nothing is left behind
  applyStyle(scale_);
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::handleEvents(double seconds) {
  if (seconds <= 0)
    glfwPollEvents();
  else if (std::isinf(seconds))
    glfwWaitEvents();
  else
    glfwWaitEventsTimeout(seconds);
}

void Window::wake() { glfwPostEmptyEvent(); }

bool Window::takeTouched() { return std::exchange(touched_, false); }

std::vector<KeyPress> Window::takeKeys() { return std::exchange(keys_, {}); }

bool Window::closing() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Window::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::show() { glfwSwapBuffers(window_); }

int Window::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return width;
}

int Window::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return height;
}

DisplayImage Window::capture() const { return gl::windowPixels(width(), height()); }

}  // namespace deltalux::viewer
