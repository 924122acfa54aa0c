#pragma once
// tinyobjloader with double precision: coordinates of surveyed buildings have more digits than a float.
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>
