// SPDX-License-Identifier: MIT
// The one unit that compiles tinygltf: no file system, no images, no exceptions.
#include <fstream>  // 2.7.0 forgets it under TINYGLTF_NO_FS
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NOEXCEPTION
#include <tiny_gltf.h>
