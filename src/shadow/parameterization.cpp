#include "shadow/parameterization.h"

#include "shadow/map_image.h"

namespace gnomon {

std::unique_ptr<Occluders> Parameterization::createOccluders(const gpu::Device& device, const FittedMap& fitted,
                                                             ChannelSet channels) const {
  return std::make_unique<MapImage>(device, fitted, channels);
}

}  // namespace gnomon
