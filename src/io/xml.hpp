#pragma once
// Documents in XML as trees of elements that know their lines. Parsing is Expat's; what readers have no use for is
// refused (entities that a document declares itself, endless nesting), so that a hostile file costs no more than its
// length.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deltalux::io {

struct XmlElement {
  std::string name;  // without a namespace's prefix
  int line = 0;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  // of the element itself, its children left out
  std::vector<XmlElement> children;

  /// The first child of that name, or null.
  const XmlElement* child(std::string_view childName) const;
  /// The child at the end of a path of names from here, or null: child("A", "B").
  template <class... Names>
  const XmlElement* child(std::string_view first, Names... rest) const {
    const XmlElement* next = child(first);
    return next ? next->child(rest...) : nullptr;
  }
  /// The value of an attribute, or null.
  const std::string* attribute(std::string_view attributeName) const;
};

/// The root of the document that `text` holds; throws InputError in the name of `file`, with the line.
XmlElement parseXml(std::string_view text, const std::string& file);

/// Whether a text begins as XML does.
bool looksLikeXml(std::string_view text);

}  // namespace deltalux::io
