#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Sha256.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <random>

using namespace tss;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// A folder that is removed again.
struct Folder {
    fs::path path = fs::path(OSGTSS_BINARY_DIR) / "buffers";
    Folder() {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    std::string operator/(const std::string& name) const { return (path / name).string(); }
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(path))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
};

/// A prim with a large array of each type that a buffer holds, and of some that it does not.
Layer bigLayer() {
    std::mt19937_64 random(11);
    Layer layer;
    Prim& prim = makePrim(layer, "/Scene/Big", "Mesh");
    const auto add = [&](const char* type, int width, const auto& number) {
        Numbers numbers{{}, width};
        for (int i = 0; i < 1200; ++i) numbers.values.push_back(number());
        Property& property = prim.properties["p" + std::to_string(prim.properties.size())];
        property.typeName = type;
        property.defaultValue = Value(std::move(numbers));
    };
    const auto real = [&] { return std::ldexp(double(random()) - 9e18, -60); };
    add("uchar[]", 0, [&] { return double(random() % 256); });
    add("int[]", 0, [&] { return double(static_cast<std::int32_t>(random())); });
    add("int3[]", 3, [&] { return double(static_cast<std::int32_t>(random())); });
    add("uint[]", 0, [&] { return double(static_cast<std::uint32_t>(random())); });
    add("float[]", 0, [&] { return double(float(real())); });
    add("point3f[]", 3, [&] { return random() % 9 == 0 ? -0.0 : double(float(real())); });
    add("quatd[]", 4, real);
    add("double[]", 0, [&] { return random() % 9 == 0 ? INFINITY : real(); });
    add("half[]", 0, [&] { return double(random() % 99); });
    add("int64[]", 0, [&] { return double(random() >> 12); });
    Property animated;
    animated.typeName = "point3f[]";
    for (const char* from : {"p5", "p5"})
        animated.timeSamples.push_back(
            {double(animated.timeSamples.size()), *prim.properties[from].defaultValue});
    animated.timeSamples.push_back({7, {}});
    prim.properties["animated"] = animated;
    return layer;
}

std::string hashOf(const std::string& bytes) {
    Sha256 hash;
    hash.add({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return hash.hex();
}

/// A scene of one attribute in a buffer of 24 bytes, three floats twice.
Json smallScene(const std::string& bytes) {
    return {{"format", "osgtss"},
            {"formatVersion", "1.0"},
            {"buffers", {{{"uri", "a.bin"}, {"byteLength", bytes.size()}, {"sha256", hashOf(bytes)}}}},
            {"primChildren",
             {{{"name", "A"},
               {"properties",
                {{"p",
                  {{"typeName", "float3[]"},
                   {"default", {{"buffer", 0}, {"byteOffset", 12}, {"count", 1}}}}}}}}}}};
}

} // namespace

TEST_CASE("big arrays go into a buffer beside the scene and come back with the same bits") {
    const Folder folder;
    const Layer layer = bigLayer();
    for (const Encoding encoding : {Encoding::Json, Encoding::Cbor}) {
        const std::string buffer = saveWithBuffer(layer, folder / "big.tss", encoding);
        const std::string scene = readWholeFile(folder / "big.tss"), bytes = readWholeFile(folder / buffer);
        CHECK(bytes.size() == 1200 * (1 + 4 + 4 + 4 + 4 + 4 + 8 + 8 + 4 + 4));
        CHECK(scene.size() < 30000); // half and int64 stay
        CHECK(writeJson(readLayer(folder / "big.tss")) == writeJson(layer));
        CHECK(saveWithBuffer(readLayer(folder / "big.tss"), folder / "big.tss", encoding) == buffer);
        CHECK(readWholeFile(folder / "big.tss") == scene);
        CHECK(folder.names() == std::vector<std::string>{buffer, "big.tss"});
        CHECK(writeUsda(readLayer(folder / "big.tss")) == writeUsda(layer)); // which has no buffers
    }
    Layer small = layer;
    findPrim(small, "/Scene/Big")->properties.clear();
    CHECK(saveWithBuffer(small, folder / "small.tss").empty());
    CHECK(readWholeFile(folder / "small.tss") == writeJson(small));
}

TEST_CASE("a scene reached by a link has its buffers where it really is") {
    const Folder folder;
    fs::create_directories(folder / "real");
    saveLayer(Layer(), folder / "real/big.tss");
    fs::create_symlink("real/big.tss", folder / "link.tss");
    saveWithBuffer(bigLayer(), folder / "link.tss");
    CHECK(folder.names() == std::vector<std::string>{"link.tss", "real"});
    CHECK(writeJson(readLayer(folder / "link.tss")) == writeJson(bigLayer()));
}

TEST_CASE("numbers in a buffer are packed and little-endian") {
    const Folder folder;
    const std::string bytes("\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\xbf\0\0\0\x80\0\0\x80\x7f", 24);
    writeFileAtomically(folder / "a.bin", bytes);
    const Layer layer = parseLayer(smallScene(bytes).dump(), folder / "a.tss");
    const std::string saved = writeJson(layer);
    CHECK(saved.find("[[-1,-0.0,\"inf\"]]") != std::string::npos);
    CHECK(saved.find("buffer") == std::string::npos);
}

TEST_CASE("a buffer that is not what the scene says is refused") {
    const Folder folder;
    const std::string bytes = "123456789012345678901234";
    writeFileAtomically(folder / "a.bin", bytes);
    fs::create_symlink("a.bin", folder / "link.bin");
    fs::create_directories(folder / "folder");
    writeFileAtomically(folder / "folder/a.bin", bytes);
    const std::string other(64, '0');
    struct Broken {
        const char* at;
        Json value; ///< null: taken away
        const char* found;
        const char* says;
    };
    const Broken cases[] = {
        {"/buffers", 3, "/buffers", "expected an array of buffers"},
        {"/buffers/0", "a.bin", "/buffers/0", "expected an object"},
        {"/buffers/0/uri", nullptr, "/buffers/0/uri", "expected the string uri"},
        {"/buffers/0/uri", 1, "/buffers/0/uri", "expected the string uri"},
        {"/buffers/0/uri", "../a.bin", "/buffers/0/uri", "expected the bare name"},
        {"/buffers/0/uri", "folder/a.bin", "/buffers/0/uri", "expected the bare name"},
        {"/buffers/0/uri", folder / "a.bin", "/buffers/0/uri", "expected the bare name"},
        {"/buffers/0/uri", "..", "/buffers/0/uri", "expected the bare name"},
        {"/buffers/0/uri", "file:a.bin", "/buffers/0/uri", "expected the bare name"},
        {"/buffers/0/uri", "folder\\a.bin", "/buffers/0/uri", "expected the bare name"},
        {"/buffers/0/uri", std::string("a.bin\0", 6), "/buffers/0/uri", "expected the bare name"},
        {"/buffers/0/uri", "b.bin", "/buffers/0/uri", "is missing"},
        {"/buffers/0/uri", "link.bin", "/buffers/0/uri", "and no link"},
        {"/buffers/0/uri", "folder", "/buffers/0/uri", "expected a regular file"},
        {"/buffers/0/byteLength", nullptr, "/buffers/0/byteLength", "expected byteLength"},
        {"/buffers/0/byteLength", 23, "/buffers/0/byteLength", "24 bytes, found 23"},
        {"/buffers/0/byteLength", 1e15, "/buffers/0/byteLength", "24 bytes, found"},
        {"/buffers/0/byteLength", -24, "/buffers/0/byteLength", "an integer of at least 0"},
        {"/buffers/0/byteLength", 24.5, "/buffers/0/byteLength", "an integer of at least 0"},
        {"/buffers/0/sha256", nullptr, "/buffers/0/sha256", "expected the string sha256"},
        {"/buffers/0/sha256", other, "/buffers/0/sha256", "expected the SHA-256"},
        {"/primChildren/0/properties/p/default/buffer", 1, "/primChildren/0/properties/p/default/buffer",
         "expected an index below 1"},
        {"/primChildren/0/properties/p/default/buffer", -1, "/primChildren/0/properties/p/default/buffer",
         "an integer of at least 0"},
        {"/primChildren/0/properties/p/default/byteOffset", nullptr,
         "/primChildren/0/properties/p/default/byteOffset", "expected byteOffset"},
        {"/primChildren/0/properties/p/default/byteOffset", 13, "/primChildren/0/properties/p/default/count",
         "expected elements inside of the buffer's 24 bytes"},
        {"/primChildren/0/properties/p/default/byteOffset", 25, "/primChildren/0/properties/p/default/count",
         "expected elements inside"},
        {"/primChildren/0/properties/p/default/count", nullptr, "/primChildren/0/properties/p/default/count",
         "expected count"},
        {"/primChildren/0/properties/p/default/count", 2, "/primChildren/0/properties/p/default/count",
         "expected elements inside"},
        {"/primChildren/0/properties/p/default/count", 1e15, "/primChildren/0/properties/p/default/count",
         "expected elements inside"},
        {"/primChildren/0/properties/p/default/count", 0.5, "/primChildren/0/properties/p/default/count",
         "an integer of at least 0"},
        {"/primChildren/0/properties/p/default/stride", 1, "/primChildren/0/properties/p/default/stride",
         "expected buffer, byteOffset and count"},
        {"/primChildren/0/properties/p/typeName", "token[]", "/primChildren/0/properties/p/default",
         "token[] has no form in a buffer"},
        {"/primChildren/0/properties/p/typeName", "float3", "/primChildren/0/properties/p/default",
         "float3 has no form in a buffer"},
        {"/primChildren/0/properties/p/typeName", "matrix4d[]", "/primChildren/0/properties/p/default",
         "no form in a buffer"},
        {"/primChildren/0/properties/p/typeName", "half[]", "/primChildren/0/properties/p/default",
         "no form in a buffer"},
        {"/primChildren/0/properties/p/timeSamples",
         {{0, {{"buffer", 0}, {"byteOffset", 0}, {"count", 1}}},
          {1, {{"buffer", 0}, {"byteOffset", 0}, {"count", 1}}}},
         "/primChildren/0/properties/p/timeSamples/1/1",
         "no byte of a buffer twice"},
        {"/buffers", nullptr, "/primChildren/0/properties/p/default", "expected an array (float3[])"},
    };
    REQUIRE_NOTHROW(parseLayer(smallScene(bytes).dump(), folder / "a.tss"));
    for (const Broken& broken : cases) {
        INFO(broken.at << " = " << broken.value);
        Json scene = smallScene(bytes);
        const Json::json_pointer at(broken.at);
        if (broken.value.is_null())
            scene[at.parent_pointer()].erase(at.back());
        else
            scene[at] = broken.value;
        try {
            parseLayer(scene.dump(), folder / "a.tss");
            FAIL_CHECK("was accepted");
        } catch (const InputError& error) {
            CHECK(error.where.file == folder / "a.tss");
            CHECK(error.where.pointer == broken.found);
            CHECK_THAT(error.message, Catch::Contains(broken.says) && Catch::Contains("expected"));
        }
    }
    CHECK_THROWS_WITH(parseLayer(smallScene(bytes).dump(), ""),
                      Catch::Contains("expected a scene that is a file"));
    writeFileAtomically(folder / "a.bin", "12345678901234567890123!");
    CHECK_THROWS_WITH(parseLayer(smallScene(bytes).dump(), folder / "a.tss"), Catch::Contains("SHA-256"));
}
