#include "base/image_codec.h"

#include "base/error.h"

#include <dlfcn.h>

namespace gnomon {

namespace {

// The program's RUNPATH says where the library is, in the build and installed; beside the program it is found, too.
const ImageCodec& load() {
  void* library = ::dlopen(kImageCodecLibrary, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw fileError(kImageCodecLibrary, ::dlerror(),
                    "it reads and writes images: keep it where the build or the installation put it, or add its folder "
                    "to LD_LIBRARY_PATH");
  const void* symbol = ::dlsym(library, kImageCodecSymbol);
  if (symbol == nullptr) throw fileError(kImageCodecLibrary, "is not Gnomon's", "look for another file of that name");
  return *static_cast<const ImageCodec*>(symbol);
}

}  // namespace

const ImageCodec& imageCodec() {
  static const ImageCodec& codec = load();
  return codec;
}

}  // namespace gnomon
