#!/usr/bin/env python3
"""Writes a corpus of broken glTF files, each wrong in one way, for the loader's tests and its fuzzer.

    tools/make_broken_gltf.py FOLDER

Only the Python 3 standard library is needed. Every file must be refused with one line.
"""
import base64
import copy
import json
import os
import struct
import sys

POSITIONS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
INDICES = struct.pack("<3H", 0, 1, 2) + b"\0\0"


def data_uri(data, kind="application/octet-stream"):
    return "data:" + kind + ";base64," + base64.b64encode(data).decode("ascii")


def triangle(binary=POSITIONS + INDICES):
    """A whole file of one triangle: 36 bytes of positions, then three 16-bit indices."""
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(binary), "uri": data_uri(binary)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
    }


def glb_of(document, binary):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    body += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


def whole_glb():
    document = triangle()
    del document["buffers"][0]["uri"]
    return glb_of(document, POSITIONS + INDICES)


def broken_json():
    """name -> document: each a small change to a good file."""
    files = {}

    def broken(name, change):
        document = triangle()
        result = change(document)
        files[name] = document if result is None else result

    def put(*path_and_value):
        *path, last, value = path_and_value

        def change(document):
            at = document
            for step in path:
                at = at[step]
            at[last] = value

        return change

    def drop(*path):
        def change(document):
            at = document
            for step in path[:-1]:
                at = at[step]
            del at[path[-1]]

        return change

    def both(first, second):
        def change(document):
            first(document)
            second(document)

        return change

    def light(definition, index=0):
        def change(document):
            document["extensions"] = {"KHR_lights_punctual": {"lights": [definition]}}
            document["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": index}}

        return change

    def camera(definition):
        def change(document):
            document["cameras"] = [definition]
            document["nodes"][0]["camera"] = 0

        return change

    def texture(image, transform=None):
        def change(document):
            info = {"index": 0}
            if transform is not None:
                info["extensions"] = {"KHR_texture_transform": transform}
            document["images"] = [image]
            document["textures"] = [{"source": 0}]
            document["materials"] = [{"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": info}}]
            document["meshes"][0]["primitives"][0]["material"] = 0

        return change

    # References.
    broken("index_accessor_out_of_range", put("meshes", 0, "primitives", 0, "indices", 7))
    broken("position_accessor_out_of_range", put("meshes", 0, "primitives", 0, "attributes", "POSITION", 9))
    broken("position_accessor_negative", put("meshes", 0, "primitives", 0, "attributes", "POSITION", -1))
    broken("material_out_of_range", put("meshes", 0, "primitives", 0, "material", 3))
    broken("mesh_out_of_range", put("nodes", 0, "mesh", 5))
    broken("mesh_index_beyond_32_bits", put("nodes", 0, "mesh", 4294967296))
    broken("scene_out_of_range", put("scene", 4))
    broken("scene_root_out_of_range", put("scenes", 0, "nodes", [0, 6]))
    broken("child_out_of_range", put("nodes", 0, "children", [12]))
    broken("camera_out_of_range", put("nodes", 0, "camera", 2))
    broken("light_out_of_range", light({"type": "point"}, 3))
    broken("buffer_out_of_range", put("bufferViews", 0, "buffer", 2))
    broken("view_out_of_range", put("accessors", 0, "bufferView", 8))
    broken("no_position", put("meshes", 0, "primitives", 0, "attributes", {}))

    # Vertex data.
    def vertex_index(values, kind=5123, code="H"):
        def change(document):
            data = struct.pack("<" + code * len(values), *values)
            binary = POSITIONS + data
            document["buffers"][0] = {"byteLength": len(binary), "uri": data_uri(binary)}
            document["bufferViews"][1]["byteLength"] = len(data)
            document["accessors"][1].update(count=len(values), componentType=kind)

        return change

    broken("index_beyond_vertices", vertex_index([0, 1, 3]))
    broken("index_restart", vertex_index([0, 1, 65535]))
    broken("index_huge", vertex_index([0, 1, 4294967295], 5125, "I"))
    broken("indices_not_a_multiple_of_three", vertex_index([0, 1, 2, 0]))
    broken("indices_signed", vertex_index([0, 1, 2], 5122, "h"))
    broken("indices_float", vertex_index([0, 1, 2], 5126, "f"))
    for name, value in (("nan", float("nan")), ("infinite", float("inf")), ("absurd", 1e30)):
        def change(document, value=value):
            binary = struct.pack("<9f", 0, 0, 0, 1, value, 0, 0, 1, 0) + INDICES
            document["buffers"][0]["uri"] = data_uri(binary)
        broken("position_" + name, change)

    # Counts, strides and offsets.
    broken("count_one_too_many", put("accessors", 0, "count", 4))
    broken("count_huge", put("accessors", 0, "count", 1 << 40))
    broken("count_of_63_bits", put("accessors", 0, "count", (1 << 63) - 1))
    broken("count_overflows_with_stride", put("accessors", 0, "count", (1 << 64) // 12 + 1))
    broken("count_negative", put("accessors", 0, "count", -3))
    broken("count_fraction", put("accessors", 0, "count", 2.5))
    broken("count_text", put("accessors", 0, "count", "3"))
    broken("index_count_huge", put("accessors", 1, "count", 1 << 50))
    broken("accessor_offset_beyond_view", put("accessors", 0, "byteOffset", 40))
    broken("accessor_offset_overflows", put("accessors", 0, "byteOffset", (1 << 64) - 4))
    broken("accessor_offset_negative", put("accessors", 0, "byteOffset", -12))
    broken("view_longer_than_buffer", put("bufferViews", 0, "byteLength", 4000))
    broken("view_offset_overflows", put("bufferViews", 0, "byteOffset", (1 << 64) - 36))
    broken("view_length_negative", put("bufferViews", 0, "byteLength", -36))
    broken("stride_overlaps", put("bufferViews", 0, "byteStride", 4))
    broken("stride_odd", put("bufferViews", 0, "byteStride", 13))
    broken("stride_huge", put("bufferViews", 0, "byteStride", 1 << 40))
    broken("stride_beyond_view", put("bufferViews", 0, "byteStride", 24))
    broken("buffer_length_huge", put("buffers", 0, "byteLength", 1 << 45))
    broken("buffer_length_zero", put("buffers", 0, "byteLength", 0))
    broken("component_type_unknown", put("accessors", 0, "componentType", 1234))
    broken("component_type_double", put("accessors", 0, "componentType", 5130))
    broken("type_unknown", put("accessors", 0, "type", "VEC7"))
    broken("type_scalar_positions", put("accessors", 0, "type", "SCALAR"))
    broken("type_matrix_positions", put("accessors", 0, "type", "MAT4"))
    broken("accessor_without_view_huge", both(drop("accessors", 0, "bufferView"), put("accessors", 0, "count", 2**44)))
    broken("accessor_sparse_index", put("accessors", 0, "sparse", {
        "count": 1, "indices": {"bufferView": 0, "componentType": 5125, "byteOffset": 12}, "values": {"bufferView": 0}}))
    broken("accessor_sparse_range", put("accessors", 0, "sparse", {
        "count": 4, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}))
    broken("accessor_sparse_float_indices", put("accessors", 0, "sparse", {
        "count": 1, "indices": {"bufferView": 0, "componentType": 5126}, "values": {"bufferView": 0}}))
    broken("accessor_sparse_malformed", put("accessors", 0, "sparse", {"count": 1, "indices": 5, "values": []}))

    def attribute_count(document):
        document["accessors"].append({"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3"})
        document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 2
    broken("normals_too_few", attribute_count)

    # Buffers.
    broken("buffer_missing_uri", drop("buffers", 0, "uri"))
    broken("buffer_missing_file", put("buffers", 0, "uri", "not_there.bin"))
    broken("buffer_is_a_folder", put("buffers", 0, "uri", ".."))
    broken("buffer_is_a_device", put("buffers", 0, "uri", "/dev/zero"))
    broken("buffer_bad_base64", put("buffers", 0, "uri", "data:application/octet-stream;base64,@@@@!!!!"))
    broken("buffer_short_base64", put("buffers", 0, "uri", data_uri(POSITIONS[:20])))
    broken("buffer_data_uri_without_comma", put("buffers", 0, "uri", "data:application/octet-stream;base64"))
    broken("buffer_outside", put("buffers", 0, "uri", "../../../../../../../../etc/hostname"))
    broken("no_buffers", drop("buffers"))
    broken("no_views", drop("bufferViews"))
    broken("no_accessors", drop("accessors"))

    # Scenes without triangles.
    broken("no_meshes", lambda d: {"asset": {"version": "2.0"}})
    broken("empty_scene", put("scenes", 0, "nodes", []))
    broken("points_only", put("meshes", 0, "primitives", 0, "mode", 0))
    broken("lines_only", put("meshes", 0, "primitives", 0, "mode", 3))
    broken("mode_unknown", put("meshes", 0, "primitives", 0, "mode", 9))
    broken("no_primitives", put("meshes", 0, "primitives", []))
    broken("zero_indices", put("accessors", 1, "count", 0))
    broken("strip_of_two", both(put("meshes", 0, "primitives", 0, "mode", 5), put("accessors", 1, "count", 2)))

    # Nodes.
    broken("node_own_child", put("nodes", 0, "children", [0]))
    broken("node_cycle", put("nodes", [{"mesh": 0, "children": [1]}, {"children": [2]}, {"children": [0]}]))
    broken("node_cycle_apart", put("nodes", [{"mesh": 0}, {"children": [2]}, {"children": [1]}]))
    broken("node_two_parents", put("nodes", [{"children": [1, 2]}, {"mesh": 0}, {"children": [1]}]))
    broken("node_root_and_child", both(put("nodes", [{"children": [1]}, {"mesh": 0}]),
                                         put("scenes", 0, "nodes", [0, 1])))
    broken("node_listed_twice", put("scenes", 0, "nodes", [0, 0]))
    broken("node_matrix_short", put("nodes", 0, "matrix", [1, 0, 0, 0]))
    broken("node_matrix_projective", put("nodes", 0, "matrix", [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]))
    broken("node_rotation_zero", put("nodes", 0, "rotation", [0, 0, 0, 0]))
    broken("node_scale_infinite", put("nodes", 0, "scale", [1e308, 1e308, 1e308]))
    broken("node_far_away", put("nodes", 0, "translation", [1e12, 0, 0]))
    broken("node_name_number", put("nodes", 0, "name", 17))
    broken("node_is_text", put("nodes", ["mesh"]))
    broken("node_skinned", put("nodes", 0, "skin", 0))
    broken("node_morphed", put("nodes", 0, "weights", [0.5]))
    broken("node_gpu_instancing", put("nodes", 0, "extensions", {
        "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}))
    broken("view_meshopt_damaged", put("bufferViews", 0, "extensions", {"EXT_meshopt_compression": {
        "buffer": 0, "byteOffset": 0, "byteLength": 20, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}}))
    broken("view_meshopt_mode", put("bufferViews", 0, "extensions", {"EXT_meshopt_compression": {
        "buffer": 0, "byteOffset": 0, "byteLength": 20, "byteStride": 12, "count": 3, "mode": "MAGIC"}}))
    broken("view_meshopt_count", put("bufferViews", 0, "extensions", {"EXT_meshopt_compression": {
        "buffer": 0, "byteOffset": 0, "byteLength": 20, "byteStride": 12, "count": 2**40, "mode": "ATTRIBUTES"}}))
    broken("primitive_draco_damaged", put("meshes", 0, "primitives", 0, "extensions", {
        "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}))

    def shared_infinity(document):
        document["nodes"] = [{"mesh": 0}, {"mesh": 0, "children": [2], "scale": [1e200, 1e200, 1e200]},
                             {"mesh": 0, "scale": [1e200, 1e200, 1e200]}]
        document["scenes"][0]["nodes"] = [0, 1]
    broken("node_chain_overflows", shared_infinity)

    def bomb(primitives, nodes):
        def change(document):
            document["meshes"][0]["primitives"] *= primitives
            document["nodes"] *= nodes
            document["scenes"][0]["nodes"] = list(range(nodes))
        return change
    broken("instancing_bomb", bomb(1200, 1000))

    def sharing_bomb(document):
        count = 40000
        binary = POSITIONS + b"\0\1\2" * count
        document["buffers"][0] = {"byteLength": len(binary), "uri": data_uri(binary)}
        document["bufferViews"][1]["byteLength"] = 3 * count
        document["accessors"][1].update(componentType=5121, count=3 * count)
        document["meshes"][0]["primitives"] *= 3000
    broken("sharing_bomb", sharing_bomb)

    # Cameras and lights.
    broken("camera_without_type", camera({"perspective": {"yfov": 1, "znear": 0.1}}))
    broken("camera_unknown_type", camera({"type": "fisheye"}))
    broken("camera_without_perspective", camera({"type": "perspective"}))
    broken("camera_fov_negative", camera({"type": "perspective", "perspective": {"yfov": -1, "znear": 0.1}}))
    broken("camera_fov_wide", camera({"type": "perspective", "perspective": {"yfov": 7, "znear": 0.1}}))
    broken("camera_near_zero", camera({"type": "perspective", "perspective": {"yfov": 1, "znear": 0}}))
    broken("camera_near_text", camera({"type": "perspective", "perspective": {"yfov": 1, "znear": "near"}}))
    broken("light_unknown_type", light({"type": "laser"}))
    broken("light_without_type", light({}))
    broken("light_negative", light({"type": "point", "intensity": -4}))
    broken("light_color_short", light({"type": "point", "color": [1, 1]}))
    broken("light_cone_inside_out", light({"type": "spot", "spot": {"innerConeAngle": 1, "outerConeAngle": 0.5}}))
    broken("light_cone_wide", light({"type": "spot", "spot": {"outerConeAngle": 4}}))

    def flat_sun(document):
        light({"type": "directional"})(document)
        document["nodes"][0]["scale"] = [1, 1, 0]
    broken("light_without_direction", flat_sun)

    # Materials and images.
    png = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + b"IHDR" + struct.pack(">IIBBBBB", 16384, 16384, 8, 6, 0, 0, 0)
    broken("image_missing", texture({"uri": "not_there.png"}))
    broken("image_nothing", texture({}))
    broken("image_bad_base64", texture({"uri": "data:image/png;base64,%%%%"}))
    broken("image_not_an_image", texture({"uri": data_uri(b"hello, world", "image/png")}))
    broken("image_truncated_and_huge", texture({"uri": data_uri(png, "image/png")}))
    broken("image_view_out_of_range", texture({"bufferView": 9}))
    broken("image_is_positions", texture({"bufferView": 0}))
    broken("image_name_number", texture({"name": 3, "uri": "a.png"}))
    broken("texture_transform_short", texture({"uri": "a.png"}, {"offset": [1]}))
    broken("texture_without_source", both(texture({"uri": "a.png"}), put("textures", [{}])))
    broken("material_alpha_mode", put("materials", [{"alphaMode": "GLASS"}]))
    broken("material_factor_short", put("materials", [{"pbrMetallicRoughness": {"baseColorFactor": [1, 1]}}]))
    broken("material_factor_large", put("materials", [{"pbrMetallicRoughness": {"baseColorFactor": [9, 1, 1, 1]}}]))
    broken("material_double_sided_text", put("materials", [{"doubleSided": "yes"}]))
    broken("material_cutoff_negative", put("materials", [{"alphaMode": "MASK", "alphaCutoff": -1}]))

    # Types and versions.
    broken("asset_missing", drop("asset"))
    broken("asset_version_number", put("asset", "version", 2.0))
    broken("nodes_object", put("nodes", {"0": {"mesh": 0}}))
    broken("meshes_text", put("meshes", "cube"))
    broken("root_array", lambda d: [d])
    broken("root_number", lambda d: 42)
    broken("requires_splats", put("extensionsRequired", ["KHR_gaussian_splatting"]))
    broken("requires_webgl", put("extensionsRequired", ["KHR_techniques_webgl"]))
    broken("version_1", put("asset", {"version": "1.0"}))
    broken("requires_unknown", put("extensionsRequired", ["ACME_teapot"]))
    broken("requires_number", put("extensionsRequired", [3]))
    return files


def broken_text():
    """name -> bytes that are no glTF at all, or only the beginning of one."""
    good = json.dumps(triangle()).encode()
    files = {
        "empty.gltf": b"",
        "one_brace.gltf": b"{",
        "trailing_comma.gltf": good[:-1] + b",}",
        "two_documents.gltf": good + good,
        "not_utf8.gltf": good.replace(b'"asset"', b'"as\xff\xfeet"'),
        "deep_arrays.gltf": b"[" * 200000,
        "deep_objects.gltf": b'{"a":' * 100000,
        "deep_extras.gltf": good[:-1] + b', "extras": ' + b"[" * 5000 + b"]" * 5000 + b"}",
        "number_overflow.gltf": good.replace(b'"count": 3', b'"count": 1e999'),
        "number_of_40_digits.gltf": good.replace(b'"count": 3', b'"count": ' + b"9" * 40),
        "text.gltf": b"solid cube\nfacet normal 0 0 1\n",
        "zeros.glb": b"\0" * 64,
        "newlines.gltf": b"\n\n\n\n",
    }
    for cut in (5, 40, 100, 200, 300, 400, len(good) - 30, len(good) - 1):
        files["cut_at_%d.gltf" % cut] = good[:cut]
    return files


def broken_glb():
    """name -> bytes of a .glb whose container is wrong."""
    good = whole_glb()
    json_length = struct.unpack_from("<I", good, 12)[0]

    def patched(offset, value):
        return good[:offset] + struct.pack("<I", value) + good[offset + 4:]

    files = {
        "version_1.glb": patched(4, 1),
        "length_short.glb": patched(8, len(good) - 4),
        "length_long.glb": patched(8, len(good) + 4),
        "length_huge.glb": patched(8, 0xFFFFFFFF),
        "json_length_zero.glb": patched(12, 0),
        "json_length_long.glb": patched(12, json_length + 4),
        "json_length_huge.glb": patched(12, 0xFFFFFFFC),
        "json_type_wrong.glb": patched(16, 0x12345678),
        "bin_length_long.glb": patched(20 + json_length, 4000),
        "bin_length_huge.glb": patched(20 + json_length, 0xFFFFFFFF),
        "bin_type_wrong.glb": patched(24 + json_length, 0x12345678),
        "trailing_bytes.glb": good + b"\0\0\0",
        "magic_only.glb": b"glTF",
    }
    for cut in (3, 8, 12, 16, 19, 20, 24, 100, 20 + json_length, 24 + json_length, len(good) - 20, len(good) - 1):
        files["cut_at_%d.glb" % cut] = good[:cut]
    document = triangle()
    del document["buffers"][0]["uri"]
    document["buffers"][0]["byteLength"] = 4000
    files["buffer_longer_than_bin.glb"] = glb_of(document, POSITIONS + INDICES)
    document = triangle()
    document["buffers"] = [{"byteLength": 44}, {"byteLength": 44}]
    files["second_buffer_without_uri.glb"] = glb_of(document, POSITIONS + INDICES)
    return files


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: make_broken_gltf.py FOLDER")
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    files = broken_text()
    files.update(broken_glb())
    for name, document in broken_json().items():
        # NaN and infinities never reach the text: they are in binary data only.
        files[name + ".gltf"] = json.dumps(copy.deepcopy(document), allow_nan=False).encode()
    for name, data in files.items():
        with open(os.path.join(folder, name), "wb") as out:
            out.write(data)
    print("%d broken files in %s" % (len(files), folder))


if __name__ == "__main__":
    main()
