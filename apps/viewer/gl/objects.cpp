#include "gl/objects.hpp"

#include <stdexcept>

namespace deltalux::viewer::gl {

namespace {
template <class Generate>
GLuint generated(Generate generate) {
  GLuint name = 0;
  generate(1, &name);
  return name;
}

std::string logOf(GLuint object, bool program) {
  GLint length = 0;
  if (program)
    glGetProgramiv(object, GL_INFO_LOG_LENGTH, &length);
  else
    glGetShaderiv(object, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), ' ');
  if (program)
    glGetProgramInfoLog(object, length, nullptr, log.data());
  else
    glGetShaderInfoLog(object, length, nullptr, log.data());
  return log;
}

GLuint compiled(GLenum stage, const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  const std::string log = logOf(shader, false);
  glDeleteShader(shader);
  throw std::runtime_error("OpenGL does not compile a shader of the viewer: " + log);
}
}  // namespace

GLuint BufferKind::make() { return generated(glGenBuffers); }
void BufferKind::destroy(GLuint name) { glDeleteBuffers(1, &name); }
GLuint VertexArrayKind::make() { return generated(glGenVertexArrays); }
void VertexArrayKind::destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
GLuint TextureKind::make() { return generated(glGenTextures); }
void TextureKind::destroy(GLuint name) { glDeleteTextures(1, &name); }
GLuint FramebufferKind::make() { return generated(glGenFramebuffers); }
void FramebufferKind::destroy(GLuint name) { glDeleteFramebuffers(1, &name); }

// GL_COPY_WRITE_BUFFER belongs to no vertex array: writing disturbs nothing that is bound.
void Buffer::assign(const void* data, std::size_t bytes, std::uint64_t& uploaded) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer_.name());
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_DRAW);
  bytes_ = bytes;
  if (data) uploaded += bytes;
}

void Buffer::write(std::size_t offset, const void* data, std::size_t bytes, std::uint64_t& uploaded) {
  if (bytes == 0) return;
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer_.name());
  glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
  uploaded += bytes;
}

void Texture2D::resize(const TextureFormat& f, int width, int height) {
  if (texture_ && internal_ == f.internal && width_ == width && height_ == height) return;
  std::uint64_t none = 0;
  assign(f, width, height, nullptr, none);
}

void Texture2D::assign(const TextureFormat& f, int width, int height, const void* texels, std::uint64_t& uploaded) {
  const bool fresh = !texture_;
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  if (fresh) {
    setFilter(GL_NEAREST, GL_NEAREST);
    setWrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (!fresh && internal_ == f.internal && width_ == width && height_ == height)
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, f.format, f.type, texels);
  else
    glTexImage2D(GL_TEXTURE_2D, 0, f.internal, width, height, 0, f.format, f.type, texels);
  internal_ = f.internal, width_ = width, height_ = height;
  if (texels) uploaded += f.texelBytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

void Texture2D::setFilter(GLint smaller, GLint larger) {
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, smaller);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, larger);
}

void Texture2D::setWrap(GLint across, GLint down) {
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, across);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, down);
}

void BufferTexture::assign(GLenum internal, const void* data, std::size_t bytes, std::uint64_t& uploaded) {
  buffer_.assign(data, bytes, uploaded);
  glBindTexture(GL_TEXTURE_BUFFER, texture_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, internal, buffer_.name());
}

Program::Program(const std::string& defines, const std::string& vertex, const std::string& fragment,
                 const std::vector<std::string>& outputs, const char* second) {
  const std::string head = "#version 330 core\n" + defines;
  const GLuint v = compiled(GL_VERTEX_SHADER, head + vertex), f = compiled(GL_FRAGMENT_SHADER, head + fragment);
  program_ = glCreateProgram();
  glAttachShader(program_, v);
  glAttachShader(program_, f);
  for (std::size_t i = 0; i < outputs.size(); ++i)
    glBindFragDataLocation(program_, static_cast<GLuint>(i), outputs[i].c_str());
  if (second) glBindFragDataLocationIndexed(program_, 0, 1, second);
  glLinkProgram(program_);
  glDeleteShader(v);
  glDeleteShader(f);
  GLint good = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &good);
  if (good) return;
  const std::string log = logOf(program_, true);
  glDeleteProgram(std::exchange(program_, 0));
  throw std::runtime_error("OpenGL does not link a shader of the viewer: " + log);
}

Program::~Program() {
  if (program_) glDeleteProgram(program_);
}

void bindTexture(int unit, GLenum target, GLuint texture) {
  glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
  glBindTexture(target, texture);
}

}  // namespace deltalux::viewer::gl
