#pragma once
// Gnomon's version, semantic: below 1.0 a minor version may break. CMakeLists.txt reads it from here.

#define GNOMON_VERSION_MAJOR 0
#define GNOMON_VERSION_MINOR 1
#define GNOMON_VERSION_PATCH 0
