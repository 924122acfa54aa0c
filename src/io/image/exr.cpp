#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstring>
#include <deltalux/error.hpp>
#include <stdexcept>

#include "io/image/formats.hpp"

namespace deltalux::io {

namespace {
constexpr const char* kViewAttribute = "radianceView";
constexpr int kMaxExrSide = 65536;  // [limit]

class MemoryOutput : public Imf::OStream {
 public:
  explicit MemoryOutput(std::string& bytes) : OStream("memory"), bytes_(bytes) {}
  void write(const char data[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, data, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

 private:
  std::string& bytes_;
  std::size_t position_ = 0;
};

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char data[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ > bytes_.size() || size > bytes_.size() - position_) throw std::runtime_error("it ends too early");
    std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

/// Radiance's default primaries and equal-energy white. [Radiance, color.h]
Imf::Chromaticities radianceChromaticities() {
  return {Imath::V2f(0.640f, 0.330f), Imath::V2f(0.290f, 0.600f), Imath::V2f(0.150f, 0.060f),
          Imath::V2f(1.0f / 3.0f, 1.0f / 3.0f)};
}

/// R, G and B of `pixels`, whose first is pixel (x0, y0).
Imf::FrameBuffer frameBufferOver(std::vector<Rgb>& pixels, int width, int x0, int y0) {
  Imf::FrameBuffer buffer;
  const std::size_t xStride = sizeof(Rgb), yStride = xStride * static_cast<std::size_t>(width);
  char* origin = reinterpret_cast<char*>(pixels.data()) - x0 * static_cast<std::ptrdiff_t>(xStride) -
                 y0 * static_cast<std::ptrdiff_t>(yStride);
  const char* names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c)
    buffer.insert(names[c],
                  Imf::Slice(Imf::FLOAT, origin + static_cast<std::size_t>(c) * sizeof(float), xStride, yStride));
  return buffer;
}
}  // namespace

std::string encodeExr(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  Imf::addChromaticities(header, radianceChromaticities());
  Imf::addWhiteLuminance(header, static_cast<float>(image.luminousEfficacy));  // cd/m2 of the pixel (1, 1, 1)
  if (!image.view.empty()) header.insert(kViewAttribute, Imf::StringAttribute(image.view));

  std::string bytes;
  MemoryOutput stream(bytes);
  {
    Imf::OutputFile file(stream, header);
    std::vector<Rgb> pixels = image.pixels;
    file.setFrameBuffer(frameBufferOver(pixels, image.width, 0, 0));
    file.writePixels(image.height);
  }
  return bytes;
}

Image decodeExr(std::string_view bytes, const std::string& fileName) {
  try {
    MemoryInput stream(bytes);
    Imf::InputFile file(stream);
    const Imath::Box2i window = file.header().dataWindow();
    for (const char* name : {"R", "G", "B"})
      if (!file.header().channels().findChannel(name))
        throw InputError(fileName, 0, std::string("the picture has no channel ") + name,
                         "only RGB pictures can be read");
    if (window.max.x - window.min.x >= kMaxExrSide || window.max.y - window.min.y >= kMaxExrSide)
      throw InputError(fileName, 0, "the picture is too large");

    Image image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    image.pixels.resize(static_cast<std::size_t>(image.width) * image.height);
    file.setFrameBuffer(frameBufferOver(image.pixels, image.width, window.min.x, window.min.y));
    file.readPixels(window.min.y, window.max.y);
    if (const auto* view = file.header().findTypedAttribute<Imf::StringAttribute>(kViewAttribute))
      image.view = view->value();
    if (Imf::hasWhiteLuminance(file.header()) && Imf::whiteLuminance(file.header()) > 0)
      image.luminousEfficacy = Imf::whiteLuminance(file.header());
    return image;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fileName, 0, std::string("this is no readable OpenEXR picture: ") + error.what());
  }
}

}  // namespace deltalux::io
