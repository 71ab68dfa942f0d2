// The code of tinygltf, which its package holds as a header. SPDX-License-Identifier: MIT
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "scene/tinygltf.h"
