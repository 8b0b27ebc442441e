// Small files that ask for much: counts without data, the same data over and over, deep nesting, paths that never end.
#include <sys/stat.h>

#include "import_test_files.hpp"

namespace import_test {
namespace {

constexpr size_t allowed = size_t{512} << 20;

/// Refused without taking memory or time.
void expect_cheaply_refused(const std::filesystem::path& file, const std::string& text) {
  EXPECT_REFUSED(app::import_gltf(file), text);
  EXPECT_TRUE(succeeds_within(allowed, [&] {
    const auto scene = app::import_gltf(file);
    return !scene.ok() && scene.error().code != umbrage::ErrorCode::out_of_memory;
  }));
}

void expect_cheaply_refused(const std::string& json, const std::string& text) {
  const TemporaryFolder folder;
  expect_cheaply_refused(folder.write("test.gltf", json), text);
}

std::string repeated(const std::string& text, size_t count, const std::string& separator = "") {
  std::string result;
  for (size_t i = 0; i < count; ++i) result.append(i == 0 ? "" : separator).append(text);
  return result;
}

const std::string asset = R"({"asset": {"version": "2.0"}, )";

TEST(Hostile, ElementsWithoutData) {
  expect_cheaply_refused(asset + R"("accessors": [{"componentType": 5126, "type": "VEC3", "count": 9007199254740992}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})",
                         "vertices");
  expect_cheaply_refused(asset + R"("accessors": [{"componentType": 5126, "type": "VEC3", "count": 4000000000}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})",
                         "decodes to more than");
}

TEST(Hostile, BufferLargerThanItsFile) {
  expect_cheaply_refused(
      asset + R"("buffers": [{"byteLength": 4000000000, "uri": "data:application/octet-stream;base64,AAAA"}],
    "bufferViews": [{"buffer": 0, "byteLength": 4000000000}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})",
      "has 3 bytes where 4000000000 are declared");
}

TEST(Hostile, OffsetsThatWrapAround) {
  const std::string bytes = Bytes().add(std::vector<float>(9, 0.5f)).buffers();
  const std::string rest = R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})";
  expect_cheaply_refused(asset + bytes +
                             R"(, "bufferViews": [{"buffer": 0, "byteOffset": 9007199254740992, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}])" +
                             rest,
                         "are beyond the 36");
  expect_cheaply_refused(asset + bytes + R"(, "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "byteOffset": 9007199254740992,
      "componentType": 5126, "type": "VEC3", "count": 3}])" +
                             rest,
                         "of a buffer view of 36");
  expect_cheaply_refused(asset + bytes + R"(, "bufferViews": [{"buffer": 0, "byteLength": 36, "byteStride": 252}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 9007199254740992}])" +
                             rest,
                         "vertices");
}

TEST(Hostile, SameDataOverAndOver) {
  const std::vector<float> positions(30000, 0.25f);
  const std::string primitive = R"({"attributes": {"POSITION": 0}})";
  expect_cheaply_refused(asset + Bytes().add(positions).buffers() +
                             R"(, "bufferViews": [{"buffer": 0, "byteLength": 120000}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 10000}],
    "meshes": [{"primitives": [)" +
                             repeated(primitive, 20000, ",") + "]}]}",
                         "over and over");
}

TEST(Hostile, PoseLargerThanTheFile) {
  // 3,000 nodes that each show the same skin of 3,000 joints.
  const std::string influences = Bytes()
                                     .add(std::vector<float>(9, 0.5f))
                                     .add(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})
                                     .add(std::vector<uint8_t>(12, 0))
                                     .buffers();
  std::string joints;
  for (int i = 0; i < 3000; ++i) joints.append(i == 0 ? "" : ",").append(std::to_string(i));
  expect_cheaply_refused(asset + influences + R"(, "bufferViews": [{"buffer": 0, "byteLength": 96}], "accessors": [
    {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
    {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "type": "VEC4", "count": 3},
    {"bufferView": 0, "byteOffset": 84, "componentType": 5121, "type": "VEC4", "count": 3}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "WEIGHTS_0": 1, "JOINTS_0": 2}}]}],
    "skins": [{"joints": [)" +
                             joints + R"(]}], "nodes": [)" + repeated(R"({"mesh": 0, "skin": 0})", 3000, ",") + "]}",
                         "joints and morph weights");
}

TEST(Hostile, DeepNesting) {
  constexpr size_t depth = 1000000;
  expect_cheaply_refused(repeated("[", depth), "JSON: ");
  expect_cheaply_refused(repeated("[", depth) + repeated("]", depth), "document: must be an object");
  // Extras may hold anything; nothing walks them.
  const TemporaryFolder folder;
  const auto file =
      folder.write("extras.gltf", asset + R"("extras": )" + repeated("[", depth) + repeated("]", depth) + "}");
  EXPECT_TRUE(succeeds_within(allowed, [&] { return app::import_gltf(file).ok(); }));
}

TEST(Hostile, LongChainOfNodes) {
  constexpr int length = 100000;
  std::string nodes;
  for (int i = 0; i + 1 < length; ++i) nodes += R"({"children": [)" + std::to_string(i + 1) + "]},";
  const auto scene = import_text(asset + R"("nodes": [)" + nodes + "{}]}");
  ASSERT_LOADS(scene);
  EXPECT_EQ(scene.value().nodes.size(), static_cast<size_t>(length));
  expect_cheaply_refused(asset + R"("nodes": [)" + nodes + R"({"children": [0]}]})", "is its own ancestor");
}

TEST(Hostile, TooManyObjects) {
  expect_cheaply_refused(asset + R"("materials": [)" + repeated("{}", 70000, ",") + "]}", "at most 65536");
}

std::string with_image(const std::string& uri) {
  return asset + R"("images": [{"uri": ")" + uri + R"("}], "textures": [{"source": 0}],
    "materials": [{"emissiveTexture": {"index": 0}}]})";
}

TEST(Hostile, PathsThatAreNotFiles) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  std::filesystem::create_directory(folder.path() / "folder");
  std::filesystem::create_symlink("/dev/zero", folder.path() / "endless");
  for (const char* name : {"pipe", "folder", "endless"}) {
    expect_cheaply_refused(folder.write("test.gltf", with_image(name)), "is not a regular file");
    EXPECT_REFUSED(app::import_gltf(folder.path() / name), "is not a regular file");
  }
  for (const char* uri : {"/dev/zero", "http://example.com/a.png", "file:///dev/zero", "%2Fdev%2Fzero"}) {
    expect_cheaply_refused(folder.write("test.gltf", with_image(uri)), "only paths relative to the file");
  }
  expect_cheaply_refused(folder.write("test.gltf", with_image("a%00b")), "only paths relative to the file");
}

/// The start of a PNG file: signature and header chunk, checksum left wrong (stb_image does not look at it).
std::string png_header(uint32_t width, uint32_t height) {
  std::vector<uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
  for (const uint32_t size : {width, height}) {
    for (const int shift : {24, 16, 8, 0}) png.push_back(static_cast<uint8_t>(size >> shift));
  }
  png.insert(png.end(), {8, 6, 0, 0, 0, 0, 0, 0, 0});
  return data_uri(png);
}

TEST(Hostile, ImagesWithoutPixels) {
  const std::string empty_image = with_image(png_header(16384, 16384));
  expect_cheaply_refused(empty_image, "images[0]: ");
  // Versions of the decoder differ in whether they notice when they read the header or when they look for pixels.
  const TemporaryFolder folder;
  const auto refused = app::import_gltf(folder.write("test.gltf", empty_image));
  ASSERT_FALSE(refused.ok());
  const std::string& message = refused.error().message;
  EXPECT_TRUE(message.find("cannot be decoded") != std::string::npos ||
              message.find("not a PNG or JPEG file") != std::string::npos)
      << message;
  expect_cheaply_refused(with_image(png_header(16385, 4)), "more than 16384 pixels a side");
  expect_cheaply_refused(with_image(png_header(0xffffffff, 0xffffffff)), "images[0]: ");
  expect_cheaply_refused(with_image("data:image/png;base64,"), "images[0]: not a PNG or JPEG file");
  expect_cheaply_refused(with_image("data:image/png;base64,!!!!"), "not base64");
}

TEST(Hostile, MissingFile) { EXPECT_REFUSED(app::import_gltf("nowhere/nothing.gltf"), "there is no file"); }

}  // namespace
}  // namespace import_test
