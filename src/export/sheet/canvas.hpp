#pragma once
// Pages that are drawn once and become SVG within a web page, or PDF. A4, in points, y downwards.
#include <deltalux/image.hpp>
#include <deltalux/math.hpp>
#include <memory>
#include <span>
#include <string>

namespace deltalux::exporting {

constexpr double kPageWidth = 595, kPageHeight = 842, kPageMargin = 42;  // [layout]

struct Ink {
  double r = 0, g = 0, b = 0;
};
constexpr Ink kBlack{0.1, 0.1, 0.12}, kGrey{0.42, 0.42, 0.45}, kPale{0.85, 0.85, 0.87}, kWhite{1, 1, 1};  // [shown]
constexpr Ink kGood{0.05, 0.48, 0.24}, kBad{0.76, 0.15, 0.11}, kAmber{0.72, 0.45, 0.02};                  // [shown]

struct TextStyle {
  double size = 9;
  Ink ink = kBlack;
  bool bold = false;
  enum class Align { Left, Middle, Right } align = Align::Left;
  bool halo = false;  // white around it, to be read on colours
};

struct Stroke {
  double width = 0.6;
  Ink ink = kBlack;
  bool dashed = false;
};

class Canvas {
 public:
  virtual ~Canvas() = default;
  virtual void beginPage() = 0;
  virtual void fill(const Vec2& at, const Vec2& size, const Ink&) = 0;
  virtual void path(std::span<const Vec2>, bool closed, const Stroke&) = 0;
  /// `at`: on the base line.
  virtual void text(const Vec2& at, const std::string&, const TextStyle& = {}) = 0;
  virtual void image(const Vec2& at, const Vec2& size, const DisplayImage&) = 0;
  /// The document's bytes; nothing is drawn after.
  virtual std::string finish() = 0;

  void line(const Vec2& a, const Vec2& b, const Stroke& stroke = {}) {
    const Vec2 ends[] = {a, b};
    path(ends, false, stroke);
  }
};

std::unique_ptr<Canvas> makeHtmlCanvas(const std::string& title);
/// Null where the library was built without.
std::unique_ptr<Canvas> makePdfCanvas(const std::string& title);

}  // namespace deltalux::exporting
