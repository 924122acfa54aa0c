#pragma once
// Names of OpenGL as values that own them.
#include <epoxy/gl.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace deltalux::viewer::gl {

/// Owns one name of a kind; 0: none.
template <class Kind>
class Object {
 public:
  Object() = default;
  ~Object() { reset(); }
  Object(Object&& o) noexcept : name_(std::exchange(o.name_, 0)) {}
  Object& operator=(Object&& o) noexcept {
    if (this != &o) reset(), name_ = std::exchange(o.name_, 0);
    return *this;
  }
  /// Makes it when first asked for.
  GLuint name() {
    if (!name_) name_ = Kind::make();
    return name_;
  }
  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }
  void reset() {
    if (name_) Kind::destroy(std::exchange(name_, 0));
  }

 private:
  GLuint name_ = 0;
};

struct BufferKind {
  static GLuint make();
  static void destroy(GLuint);
};
struct VertexArrayKind {
  static GLuint make();
  static void destroy(GLuint);
};
struct TextureKind {
  static GLuint make();
  static void destroy(GLuint);
};
struct FramebufferKind {
  static GLuint make();
  static void destroy(GLuint);
};
using VertexArray = Object<VertexArrayKind>;
using TextureName = Object<TextureKind>;
using Framebuffer = Object<FramebufferKind>;

/// A buffer that knows its size and counts what is written into it.
class Buffer {
 public:
  /// New contents of any size.
  void assign(const void* data, std::size_t bytes, std::uint64_t& uploaded);
  /// A part of it.
  void write(std::size_t offset, const void* data, std::size_t bytes, std::uint64_t& uploaded);
  GLuint name() { return buffer_.name(); }
  std::size_t bytes() const { return bytes_; }

 private:
  Object<BufferKind> buffer_;
  std::size_t bytes_ = 0;
};

/// What a texture of two dimensions holds, and how it is read.
struct TextureFormat {
  GLint internal;
  GLenum format, type;
  std::size_t texelBytes;
};
inline constexpr TextureFormat kRgba32F{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
inline constexpr TextureFormat kRgb32F{GL_RGB32F, GL_RGB, GL_FLOAT, 12};
inline constexpr TextureFormat kR32F{GL_R32F, GL_RED, GL_FLOAT, 4};
inline constexpr TextureFormat kR32Ui{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
inline constexpr TextureFormat kRgba8{GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
inline constexpr TextureFormat kDepth{GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 4};

/// A texture of two dimensions without smaller levels, read nearest unless told otherwise.
class Texture2D {
 public:
  /// Makes it of a size, contents undefined; nothing where it has that size and format already.
  void resize(const TextureFormat&, int width, int height);
  /// New contents of any size.
  void assign(const TextureFormat&, int width, int height, const void* texels, std::uint64_t& uploaded);
  void setFilter(GLint smaller, GLint larger);
  void setWrap(GLint across, GLint down);
  GLuint name() { return texture_.name(); }
  GLuint get() const { return texture_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  TextureName texture_;
  GLint internal_ = 0;
  int width_ = 0, height_ = 0;
};

/// A buffer that shaders read texel by texel.
class BufferTexture {
 public:
  void assign(GLenum internal, const void* data, std::size_t bytes, std::uint64_t& uploaded);
  Buffer& buffer() { return buffer_; }
  GLuint name() { return texture_.name(); }

 private:
  Buffer buffer_;
  TextureName texture_;
};

/// A linked program. Throws std::runtime_error with the compiler's words.
class Program {
 public:
  Program() = default;
  /// `defines`: lines that stand before both sources. `outputs`: names of fragment outputs by colour number; one name
  /// given as `second` is index 1 of colour 0 (dual source blending).
  Program(const std::string& defines, const std::string& vertex, const std::string& fragment,
          const std::vector<std::string>& outputs, const char* second = nullptr);
  ~Program();
  Program(Program&& o) noexcept : program_(std::exchange(o.program_, 0)) {}
  Program& operator=(Program&& o) noexcept {
    std::swap(program_, o.program_);
    return *this;
  }
  void use() const { glUseProgram(program_); }
  GLint at(const char* uniform) const { return glGetUniformLocation(program_, uniform); }
  explicit operator bool() const { return program_ != 0; }

 private:
  GLuint program_ = 0;
};

/// Binds a texture for reading.
void bindTexture(int unit, GLenum target, GLuint texture);

}  // namespace deltalux::viewer::gl
