// The parsers and image decoders of the import libraries, compiled here so that the sanitizers and the fuzzer see into
// them. The definitions of the executable take precedence over those of the shared libraries.
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#define TINYOBJLOADER_IMPLEMENTATION
#include "io/obj/tinyobj.hpp"
