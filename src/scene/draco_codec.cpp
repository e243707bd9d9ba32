#include "scene/draco_codec.h"

#include <algorithm>
#include <memory>

#include <draco/compression/decode.h>

namespace gnomon {

namespace {

std::string decodeDraco(const unsigned char* bytes, size_t size, DracoMesh& out) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes), size);
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return decoded.status().error_msg_string();
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  for (uint32_t i = 0; i < mesh->num_faces(); ++i)
    for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(i))) out.corners.push_back(corner.value());
  for (int i = 0; i < mesh->num_attributes(); ++i) {
    const draco::PointAttribute& source = *mesh->attribute(i);
    DracoMesh::Attribute attribute{.id = source.unique_id(), .components = std::min<int>(source.num_components(), 4)};
    const size_t components = static_cast<size_t>(attribute.components);
    attribute.values.resize(components * mesh->num_points());
    for (uint32_t point = 0; point < mesh->num_points(); ++point)
      source.ConvertValue<float>(source.mapped_index(draco::PointIndex(point)),
                                 static_cast<int8_t>(attribute.components), &attribute.values[components * point]);
    out.attributes.push_back(std::move(attribute));
  }
  return "";
}

}  // namespace

}  // namespace gnomon

extern "C" __attribute__((visibility("default"))) const gnomon::DracoCodec gnomonDracoCodec = {
    .decode = gnomon::decodeDraco,
};
