// Pages as SVG in one web page, to be read on a screen and printed as they are.
#include <fmt/format.h>

#include "export/drawing.hpp"
#include "export/packing.hpp"
#include "export/sheet/canvas.hpp"
#include "io/image/formats.hpp"

namespace deltalux::exporting {

namespace {

std::string css(const Ink& ink) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(255 * v)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(ink.r), byte(ink.g), byte(ink.b));
}

class HtmlCanvas : public Canvas {
 public:
  explicit HtmlCanvas(const std::string& title) {
    html_ = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n<style>\n"
        "body {{ margin: 0; background: #ddd; font-family: \"DejaVu Sans\", Verdana, sans-serif; }}\n"
        "svg {{ display: block; width: 210mm; height: 297mm; margin: 6mm auto; background: white; }}\n"
        "@page {{ size: A4; margin: 0; }}\n"
        "@media print {{ body {{ background: none; }} svg {{ margin: 0; break-after: page; }} }}\n"
        "</style>\n</head>\n<body>\n",
        inXml(title));
  }
  void beginPage() override {
    endPage();
    html_ +=
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\">\n", kPageWidth, kPageHeight);
    open_ = true;
  }
  void fill(const Vec2& at, const Vec2& size, const Ink& ink) override {
    html_ += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" "
        "shape-rendering=\"crispEdges\"/>\n",
        at.x, at.y, size.x, size.y, css(ink));
  }
  void path(std::span<const Vec2> points, bool closed, const Stroke& stroke) override {
    html_ += "<path fill=\"none\" d=\"";
    for (std::size_t i = 0; i < points.size(); ++i)
      html_ += fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : "L", points[i].x, points[i].y);
    html_ += fmt::format("{}\" stroke=\"{}\" stroke-width=\"{:g}\"{}/>\n", closed ? "Z" : "", css(stroke.ink),
                         stroke.width, stroke.dashed ? " stroke-dasharray=\"4 3\"" : "");
  }
  void text(const Vec2& at, const std::string& text, const TextStyle& style) override {
    const char* anchor = style.align == TextStyle::Align::Left     ? "start"
                         : style.align == TextStyle::Align::Middle ? "middle"
                                                                   : "end";
    html_ +=
        fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:g}\" text-anchor=\"{}\" fill=\"{}\"{}{}>{}</text>\n",
                    at.x, at.y, style.size, anchor, css(style.ink), style.bold ? " font-weight=\"bold\"" : "",
                    style.halo ? " stroke=\"white\" stroke-width=\"2\" paint-order=\"stroke\"" : "", inXml(text));
  }
  void image(const Vec2& at, const Vec2& size, const DisplayImage& picture) override {
    html_ += fmt::format(
        "<image x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" href=\"data:image/png;base64,{}\"/>\n",
        at.x, at.y, size.x, size.y, base64(io::encodePng(picture)));
  }
  std::string finish() override {
    endPage();
    return std::move(html_) + "</body>\n</html>\n";
  }

 private:
  void endPage() {
    if (open_) html_ += "</svg>\n";
    open_ = false;
  }

  std::string html_;
  bool open_ = false;
};

}  // namespace

std::unique_ptr<Canvas> makeHtmlCanvas(const std::string& title) { return std::make_unique<HtmlCanvas>(title); }

}  // namespace deltalux::exporting
