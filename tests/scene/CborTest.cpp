#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/ReadTree.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/RandomLayer.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

using namespace tss;

TEST_CASE("the binary twin of a random layer is the same layer") {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        INFO("seed " << seed);
        const Layer layer = RandomLayer(seed).layer();
        const std::string bytes = writeCbor(layer);
        REQUIRE(looksLikeCbor(bytes));
        const Layer back = parseLayer(bytes, "random.tss");
        REQUIRE(back == layer);
        REQUIRE(writeCbor(back) == bytes);
        REQUIRE(writeJson(back) == writeJson(layer));
    }
}

TEST_CASE("binary scenes that are cut short or changed are refused or read, never anything else") {
    const std::string good = writeCbor(toLayer(samples::brow()));
    for (std::size_t size = 0; size < good.size(); ++size)
        CHECK_THROWS_AS(parseLayer(good.substr(0, size), ""), InputError);
    std::mt19937_64 random(3);
    for (int round = 0; round < 20000; ++round) {
        std::string bad = good;
        for (std::size_t n = 1 + random() % 3; n > 0; --n)
            bad[random() % bad.size()] = static_cast<char>(random());
        try {
            readScene(parseLayer(bad, ""), "");
        } catch (const InputError&) {
        }
    }
}

TEST_CASE("what CBOR can say and a scene cannot is refused") {
    const std::pair<std::string, std::string> items[] = {
        {std::string("\xA1\x61\x61\x9B\x10\0\0\0\0\0\0\0", 12),
         "no more items than bytes are left"}, // 2^60 items
        {std::string("\xBB\x10\0\0\0\0\0\0\0", 9), "no more items than bytes are left"},
        {std::string("\xA1\x61\x61\x7B\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 12),
         "no more items than bytes are left"},
        {"\xA1\x61\x61\x41\x61", "no byte strings"},
        {"\xA1\x61\x61\xC1\x01", "no byte strings and no tags"},
        {"\xA1\x61\x61\x9F\xFF", "a definite length"},
        {"\xA1\x01\x01", "a text as key"},
        {"\xA1\x61\xFF\x01", "text in UTF-8"},
        {"\xA1\x61\x61\xF7", "true, false, null or a number"},
        {std::string("\xA1\x61\x61\xF9\x7C\x00", 6), "a finite number"},
        {"\xA1\x61\x61\x3B\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", "an integer of 64 bits"},
        {"\xA1\x61\x61\x01\x01", "the end of the file"},
        {"\xA2\x61\x61\x01\x61\x61\x01", "each key once"},
        {"\xA1\x61\x61" + std::string(70, '\x81') + "\x01", "at most 64 levels"},
    };
    for (const auto& [bytes, says] : items)
        CHECK_THROWS_WITH(parseLayer(bytes, "bad.tss"),
                          Catch::StartsWith("bad.tss: ") && Catch::Contains(says));
}

TEST_CASE("half floats of other writers are read") {
    const auto number = [](const char* half) {
        return *parseCbor(std::string("\xA1\x61\x61\xF9") + std::string(half, 2), "")
                    .as<Value::Object>()
                    ->at("a")
                    .as<double>();
    };
    CHECK(number("\x3C\x00") == 1);
    CHECK(number("\xC4\x00") == -4);
    CHECK(number("\x7B\xFF") == 65504);
    CHECK(number("\x00\x01") == std::ldexp(1.0, -24));
    CHECK(std::signbit(number("\x80\x00")));
}
