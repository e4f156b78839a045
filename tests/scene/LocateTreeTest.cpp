#include "bake/base/AtomicFile.h"
#include "bake/scene/ReadTree.h"
#include "bake/scene/ValidateScene.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/RandomLayer.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>

using namespace tss;

namespace {

std::pair<std::size_t, std::size_t> locate(std::string_view text, const std::string& pointer) {
    const TextPosition at = locateJson(text, {pointer}).at(0);
    return {at.line, at.column};
}

using At = std::pair<std::size_t, std::size_t>;

} // namespace

TEST_CASE("a value of a JSON text is found by its pointer") {
    const std::string text = "{\"a\": [1, {\"b\": \"x, ] }\"},\n  [2]],\n"
                             " \"c/d~\" : {\"é\": 3, \"\": [ ], \"e\": null}, \"a\": 4}";
    CHECK(locate(text, "") == At(1, 1));
    CHECK(locate(text, "/c~1d~0") == At(3, 11));
    CHECK(locate(text, "/c~1d~0/é") == At(3, 17)); // columns count characters
    CHECK(locate(text, "/c~1d~0/e") == At(3, 34));
    CHECK(locate(text, "/c~1d~0/") == At(3, 24));
    CHECK(locate(text, "/a") == At(3, 46)); // the later of two
    std::string first = text.substr(0, text.rfind(','));
    first += '}';
    CHECK(locate(first, "/a/1/b") == At(1, 17));
    CHECK(locate(first, "/a/2/0") == At(2, 4));
    CHECK(locate(first, "/c~1d~0/e") == At(3, 34)); // behind the array
    CHECK(locate(first, "/a/7") == At(1, 7));       // the array, as it has no such element
    CHECK(locate(first, "/c~1d~0/e/f") == At(3, 34));
    CHECK(locate("{\"a\": {\"b\": [", "/a/b/0") == At(1, 14)); // cut short
    CHECK(locate("", "/a") == At(1, 1));
}

TEST_CASE("every value of random layers is found where the text holds it") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const std::string text = writeJson(RandomLayer(seed).layer());
        const auto flat = nlohmann::json::parse(text).flatten(); // a pointer each
        std::vector<std::string> pointers;
        for (const auto& [pointer, value] : flat.items())
            if (pointer.find('"') == std::string::npos && pointer.find('\\') == std::string::npos &&
                pointer.find('\n') == std::string::npos && pointer.find('\x01') == std::string::npos)
                pointers.push_back(pointer);
        REQUIRE(pointers.size() >= 2);
        const auto positions = locateJson(text, pointers);
        for (std::size_t i = 0; i < pointers.size(); ++i) {
            std::size_t offset = 0;
            for (std::size_t line = 1; line < positions[i].line; ++line) offset = text.find('\n', offset) + 1;
            for (std::size_t column = 1; column < positions[i].column; ++offset)
                column += (text[offset + 1] & 0xC0) != 0x80;
            const auto& value = flat[pointers[i]];
            INFO("seed " << seed << " " << pointers[i] << " = " << value << " at "
                         << text.substr(offset, 30));
            const char first = value.is_string()   ? '"'
                               : value.is_object() ? '{'
                               : value.is_array()  ? '['
                                                   : text[offset];
            CHECK(text[offset] == first);
            if (value.is_number_integer())
                CHECK(std::stold(text.substr(offset, 30)) == value.get<long double>());
        }
    }
}

TEST_CASE("the parser and another one take the same texts") {
    std::mt19937_64 random(7);
    const std::string pieces = "{}[]:,\"\\ue0019.-+truefalsnl\n \x01\x80\xC3\xA9/*";
    std::size_t good = 0;
    for (int round = 0; round < 60000; ++round) {
        std::string text = R"({"a": [1, -0.5e3, "\u00e9\n", true, null], "b": {"c": 12}})";
        for (std::size_t n = random() % 4; n > 0; --n) {
            const std::size_t at = random() % text.size();
            switch (random() % 3) {
            case 0:
                text[at] = pieces[random() % pieces.size()];
                break;
            case 1:
                text.erase(at, 1 + random() % 3);
                break;
            default:
                text.insert(at, 1, pieces[random() % pieces.size()]);
            }
        }
        bool mine = true;
        try {
            parseJson(text, "");
        } catch (const InputError& error) {
            if (error.message.find("each key once") != std::string::npos)
                continue; // which the other one takes
            mine = false;
        }
        INFO(text);
        REQUIRE(mine == nlohmann::json::accept(text));
        good += mine;
    }
    CHECK(good > 1000);
}

TEST_CASE("arrays of numbers are taken as another parser takes them, number by number") {
    std::mt19937_64 random(9);
    const std::string tokens[] = {"0",
                                  "-0",
                                  "-0.0",
                                  "1",
                                  "-12",
                                  "9007199254740993",
                                  "1.5",
                                  "1e5",
                                  "1E-7",
                                  "-2.e1",
                                  "3.",
                                  ".5",
                                  "01",
                                  "-",
                                  "1e400",
                                  "1e-9",
                                  "5e-324",
                                  "1e",
                                  "+1",
                                  "18446744073709551615",
                                  "0x1",
                                  "inf",
                                  "0.1",
                                  "123456789012345",
                                  "1234567890123456",
                                  "[1, 2]",
                                  "1e-400"};
    const std::string gaps[] = {",", ",", ",", ",", ", ", " ,", ",\n", " ", ",,"};
    std::size_t good = 0;
    for (int round = 0; round < 60000; ++round) {
        std::string text = random() % 2 ? "[" : "[ ";
        for (std::size_t n = random() % 5; n > 0; --n) {
            text += tokens[random() % std::size(tokens)];
            if (n > 1) text += gaps[random() % std::size(gaps)];
        }
        text += random() % 8 ? "]" : ",]";
        INFO(text);
        std::string mine, other = "refused";
        try {
            mine = jsonText(parseJson(text, ""));
            ++good;
        } catch (const InputError&) {
            mine = "refused";
        }
        if (const auto json = nlohmann::json::parse(text, nullptr, false); !json.is_discarded()) {
            Value::Array all; // each by itself, which no block of numbers is read in
            for (const auto& element : json) {
                const std::string one = element.dump();
                all.push_back(parseJson(one, ""));
            }
            other = jsonText(parseJson(jsonText(Value(std::move(all))), ""));
        }
        REQUIRE(mine == other);
    }
    CHECK(good > 1000);
}

TEST_CASE("validation says line and column of what is wrong, in text files") {
    const std::string name = std::string(OSGTSS_BINARY_DIR) + "/located.tss";
    const auto errorsOf = [&](const std::string& content) {
        writeFileAtomically(name, content);
        const auto errors = validateScene(name);
        std::filesystem::remove(name);
        return errors;
    };
    const std::string head = "{\"format\": \"osgtss\", \"formatVersion\": \"1.0\",\n";
    const auto wrong = errorsOf(head + " \"metadata\": {\"upAxis\": \"X\",\n  \"metersPerUnit\": 0}}");
    REQUIRE(wrong.size() == 2);
    CHECK(wrong[0].text() ==
          name + ":3:20: /metadata/metersPerUnit: expected a number above 0, found number 0");
    CHECK(wrong[1].position.line == 2);
    CHECK(wrong[1].position.column == 25);
    const auto syntax = errorsOf(head + " \"metadata\": {\"upAxis\" \"X\"}}");
    REQUIRE(syntax.size() == 1);
    CHECK(syntax[0].position.line == 2);
    CHECK(syntax[0].position.column == 24);
    CHECK_THAT(syntax[0].message, Catch::Contains("line 2, column 24"));
    const auto twice = errorsOf(head + " \"metadata\": {\"upAxis\": \"Y\",\n\"upAxis\": \"Z\"}}");
    REQUIRE(twice.size() == 1);
    CHECK(twice[0].position.line == 3);
    CHECK(twice[0].position.column == 1);
    const auto binary = errorsOf("\xA1\x66"
                                 "format\x63"
                                 "abc");
    REQUIRE(binary.size() == 1);
    CHECK(binary[0].position.line == 0);
    CHECK_THAT(binary[0].text(), Catch::StartsWith(name + ": /format: "));
}
