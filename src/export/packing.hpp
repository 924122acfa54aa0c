#pragma once
// Bytes on their way into a page: gzip [RFC 1952], and base64 around it [RFC 4648].
#include <string>
#include <string_view>

namespace deltalux::exporting {

/// The same bytes in give the same bytes out: no time, no name. Less than 4 GB.
std::string gzip(std::string_view bytes);
/// Without line breaks, padded.
std::string base64(std::string_view bytes);

}  // namespace deltalux::exporting
