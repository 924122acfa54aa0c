#pragma once
// Pictures that lie over the drawing: what the Render Cache knows of mirrors, gloss and glass, and the picture that is
// made better at rest. Each pixel has a weight.
#include "drawing.hpp"
#include "gl/objects.hpp"

namespace deltalux::viewer::gl {

class Layers {
 public:
  /// Returns the bytes uploaded: none where no pixel is known.
  std::uint64_t setCache(const CacheFrame&);
  void dropCache() { hasCache_ = false; }
  /// Weights grow with the rays of a pixel, so that the picture comes in without a jump. Uploads only another picture
  /// than the one before.
  std::uint64_t setPicture(std::shared_ptr<const Picture>);
  void dropPicture() { hasPicture_ = false; }

  bool hasCache() const { return hasCache_; }
  bool hasPicture() const { return hasPicture_; }
  GLuint cache() { return cache_.name(); }
  GLuint picture() { return picture_.name(); }

 private:
  Texture2D cache_, picture_;
  std::shared_ptr<const Picture> pictureUploaded_;
  bool hasCache_ = false, hasPicture_ = false;
};

}  // namespace deltalux::viewer::gl
