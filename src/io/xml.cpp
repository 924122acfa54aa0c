#include "io/xml.hpp"

#include <expat.h>

#include <algorithm>
#include <climits>
#include <deltalux/error.hpp>
#include <exception>
#include <memory>

#include "io/trimmed.hpp"

namespace deltalux::io {

namespace {

constexpr std::size_t kDeepest = 64, kMostElements = 8'000'000;  // [limit]
constexpr const char* kXmlHint = "get the file again from where it came from";

std::string localName(const char* name) {
  const std::string_view whole = name;
  return std::string(whole.substr(whole.rfind(':') + 1));  // npos + 1 is 0
}

/// Builds the tree while Expat calls. No exception may pass through Expat, which is C: the first one is kept.
class TreeBuilder {
 public:
  TreeBuilder(XML_Parser parser, const std::string& file) : parser_(parser), file_(file) {}

  void open(const char* name, const char** attributes) {
    guarded([&] {
      if (++count_ > kMostElements) fail("has more than eight million elements");
      if (path_.size() == kDeepest) fail("nests elements deeper than " + std::to_string(kDeepest));
      XmlElement* element = &root_;
      if (!path_.empty()) element = &path_.back()->children.emplace_back();
      element->name = localName(name);
      element->line = line();
      for (; *attributes; attributes += 2) element->attributes.emplace_back(localName(attributes[0]), attributes[1]);
      path_.push_back(element);
    });
  }
  void close() {
    if (!path_.empty()) path_.pop_back();
  }
  void text(const char* characters, int length) {
    guarded([&] {
      if (!path_.empty()) path_.back()->text.append(characters, static_cast<std::size_t>(length));
    });
  }
  void declareEntity() {
    guarded([&] { fail("declares entities of its own"); });
  }

  int line() const { return static_cast<int>(std::min<XML_Size>(XML_GetCurrentLineNumber(parser_), INT_MAX)); }
  const std::exception_ptr& error() const { return error_; }
  XmlElement take() { return std::move(root_); }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, line(), message, kXmlHint); }
  template <class Work>
  void guarded(const Work& work) {
    if (error_) return;
    try {
      work();
    } catch (...) {
      error_ = std::current_exception();
      XML_StopParser(parser_, XML_FALSE);
    }
  }

  XML_Parser parser_;
  const std::string& file_;
  XmlElement root_;
  std::vector<XmlElement*> path_;  // parents of what is open: none of them gets a sibling while it is
  std::size_t count_ = 0;
  std::exception_ptr error_;
};

TreeBuilder& builderOf(void* data) { return *static_cast<TreeBuilder*>(data); }

void onOpen(void* data, const XML_Char* name, const XML_Char** attributes) { builderOf(data).open(name, attributes); }
void onClose(void* data, const XML_Char*) { builderOf(data).close(); }
void onText(void* data, const XML_Char* characters, int length) { builderOf(data).text(characters, length); }
void onEntity(void* data, const XML_Char*, int, const XML_Char*, int, const XML_Char*, const XML_Char*, const XML_Char*,
              const XML_Char*) {
  builderOf(data).declareEntity();
}

}  // namespace

const XmlElement* XmlElement::child(std::string_view childName) const {
  const auto found = std::ranges::find(children, childName, &XmlElement::name);
  return found == children.end() ? nullptr : &*found;
}

const std::string* XmlElement::attribute(std::string_view attributeName) const {
  const auto found = std::ranges::find(attributes, attributeName, &std::pair<std::string, std::string>::first);
  return found == attributes.end() ? nullptr : &found->second;
}

XmlElement parseXml(std::string_view text, const std::string& file) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  TreeBuilder builder(parser.get(), file);
  XML_SetUserData(parser.get(), &builder);
  XML_SetElementHandler(parser.get(), onOpen, onClose);
  XML_SetCharacterDataHandler(parser.get(), onText);
  XML_SetEntityDeclHandler(parser.get(), onEntity);
  constexpr std::size_t kPiece = 1 << 24;  // Expat counts in int [limit]
  XML_Status status = XML_STATUS_OK;
  for (std::size_t begin = 0; status == XML_STATUS_OK; begin += kPiece) {
    const std::string_view piece = text.substr(std::min(begin, text.size()), kPiece);
    const bool last = begin + piece.size() >= text.size();
    status = XML_Parse(parser.get(), piece.data(), static_cast<int>(piece.size()), last);
    if (last) break;
  }
  if (builder.error()) std::rethrow_exception(builder.error());
  if (status != XML_STATUS_OK)
    throw InputError(file, builder.line(),
                     std::string("is not XML: ") + XML_ErrorString(XML_GetErrorCode(parser.get())), kXmlHint);
  return builder.take();
}

bool looksLikeXml(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return trimmed(text.substr(0, 256)).starts_with('<');
}

}  // namespace deltalux::io
