# cmake -DPAGE=web/dist/index.html -DOUT=page_template.cpp -P embed_page.cmake: the page's bytes as a C++ source.
file(READ ${PAGE} digits HEX)
string(REGEX REPLACE "(................................................................)" "\\1\n" digits "${digits}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" digits "${digits}")
string(REPLACE "\n" "\"\n\"" digits "${digits}")
file(SIZE ${PAGE} size)
file(WRITE ${OUT} "#include \"export/page_template.hpp\"\n\nnamespace deltalux::exporting {\n
std::string_view pageTemplate() {\n  static const char bytes[] =\n\"${digits}\";\n  return {bytes, ${size}};\n}\n
}  // namespace deltalux::exporting\n")
