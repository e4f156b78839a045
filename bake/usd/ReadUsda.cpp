// Why a parser of our own: what reads USD's text form is OpenUSD itself and tinyusdz. Debian packages
// neither. OpenUSD is some 200 MB of build for one text format; tinyusdz is younger than its format, is to be
// had as a source tree only, and neither keeps the text's own layers, list ops and line numbers together,
// which a scene file is refused with. The grammar is small and is that of OpenUSD's documentation of `.usda`,
// version 1.0.
#include "bake/usd/ReadUsda.h"

#include "bake/scene/Utf8.h"
#include "bake/usd/UsdaValue.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <utility>

namespace tss {

namespace {

constexpr std::array listOps = {"prepend", "append", "delete", "add", "reorder"};
/// Metadata that is a list, and what it is called in a layer.
constexpr std::array<std::pair<const char*, const char*>, 6> lists = {{{"apiSchemas", "apiSchemas"},
                                                                       {"references", "references"},
                                                                       {"payload", "payload"},
                                                                       {"inherits", "inheritPaths"},
                                                                       {"specializes", "specializes"},
                                                                       {"variantSets", "variantSets"}}};

bool isName(const std::string& name) {
    std::string ascii = name;
    for (char& c : ascii)
        if (static_cast<unsigned char>(c) > 127) c = 'x';
    return isPrimName(ascii);
}

class Parser {
public:
    Parser(std::string_view text, const std::string& file, std::string folder, UsdBudget& budget)
        : cursor_(text, file, budget), folder_(std::move(folder)) {
        layer_.file = file;
    }

    UsdLayer parse() {
        if (cursor_.peek() == '(')
            readMetadata([&](const std::string& key, const std::string& op) { readLayerKey(key, op); },
                         layer_.metadata);
        std::set<std::string> names;
        while (cursor_.peek() != '\0') {
            if (cursor_.takeWord("reorder")) {
                cursor_.word("rootPrims");
                cursor_.expect('=');
                parseUsdaValue(cursor_, 0);
                continue;
            }
            layer_.children.push_back(readPrim("", names, 1));
            while (cursor_.take(';')) {
            }
        }
        return std::move(layer_);
    }

private:
    // Metadata

    template <class ReadKey>
    void readMetadata(const ReadKey& readKey, Value::Object& metadata) {
        cursor_.expect('(');
        while (!cursor_.take(')')) {
            if (cursor_.take(';') || cursor_.take(',')) continue;
            if (cursor_.atString()) {
                metadata["comment"] = Value(cursor_.string("a comment"));
                continue;
            }
            std::string op, key = cursor_.word("a key of metadata, or \")\"", true);
            if (std::ranges::find(listOps, key) != listOps.end() && cursor_.atWord())
                op = std::exchange(key, cursor_.word("a key", true));
            cursor_.expect('=');
            if (key == "relocates")
                cursor_.refuse(
                    "relocates are not read; expected a stage without them, as usdcat --flatten writes it");
            cursor_.spend(sizeof(Value::Object::value_type) + 64);
            readKey(key, op);
        }
    }

    /// One key that is like any other.
    void readPlain(const std::string& key, const std::string& op, Value::Object& metadata) {
        static const std::set<std::string> flags = {"active", "instanceable", "hidden", "noLoadHint"};
        Value value = parseUsdaValue(cursor_, flags.contains(key) ? "bool" : "", 1);
        if (op.empty())
            metadata[key == "doc" ? "documentation" : key] = std::move(value);
        else
            addList(metadata, key, op,
                    value.as<Value::Array>() ? *value.as<Value::Array>() : Value::Array{value});
    }

    void readLayerKey(const std::string& key, const std::string& op) {
        if (key == "subLayers")
            for (const Value& item : readArcs(true)) layer_.subLayers.push_back(*item.as<std::string>());
        else
            readPlain(key, op, layer_.metadata);
    }

    void readPrimKey(UsdSpec& spec, const std::string& key, const std::string& op) {
        Value::Object& metadata = spec.prim.metadata;
        const auto list = std::ranges::find_if(lists, [&](const auto& l) { return key == l.first; });
        if (key == "variants") {
            metadata["variantSelection"] = Value(parseUsdaDictionary(cursor_, 1));
        } else if (key == "clips" || key == "clipSets") {
            parseUsdaValue(cursor_, 1);
            note("value clips of " + cursor_.openPath());
        } else if (list == lists.end()) {
            readPlain(key, op, metadata);
        } else if (key == "apiSchemas" || key == "variantSets") {
            addList(metadata, list->second, op, readTexts());
        } else {
            addList(metadata, list->second, op, readArcs(key == "references" || key == "payload"));
        }
    }

    /// A text or an array of texts; None is none.
    Value::Array readTexts() {
        const Value value = parseUsdaValue(cursor_, 1);
        Value::Array items;
        if (value.as<std::string>()) items.push_back(value);
        if (const auto* array = value.as<Value::Array>()) items = *array;
        for (const Value& item : items)
            if (!item.as<std::string>()) cursor_.refuse("expected texts, found " + describe(item));
        return items;
    }

    void addList(Value::Object& metadata, const std::string& key, const std::string& op, Value::Array items) {
        Value& list = metadata[key];
        if (op.empty()) {
            list = Value(std::move(items));
            return;
        }
        if (!list.as<Value::Object>()) list = Value(Value::Object());
        (*list.as<Value::Object>())[op] = Value(std::move(items));
    }

    /// @FILE@, @FILE@</Prim> or </Prim>, one or an array of them, or None.
    Value::Array readArcs(bool files) {
        Value::Array arcs;
        if (cursor_.takeWord("None")) return arcs;
        if (!cursor_.take('[')) {
            arcs.push_back(readArc(files));
            return arcs;
        }
        while (!cursor_.take(']')) {
            arcs.push_back(readArc(files));
            if (!cursor_.take(',') && cursor_.peek() != ']') cursor_.refuseFound("\",\" or \"]\"");
        }
        return arcs;
    }

    Value readArc(bool files) {
        std::string arc;
        if (files && cursor_.peek() == '@') arc = "@" + anchored(cursor_.asset()) + "@";
        if (cursor_.peek() == '<') {
            const std::string path = cursor_.absolutePath();
            arc += arc.empty() ? path : path.empty() ? "" : "<" + path + ">";
        } else if (arc.empty()) {
            cursor_.refuseFound(files ? "a file between @, or a path between < and >"
                                      : "a path between < and >");
        }
        if (cursor_.peek() == '(') {
            Value::Object offset;
            readMetadata([&](const std::string& key, const std::string& op) { readPlain(key, op, offset); },
                         offset);
            const auto differs = [&](const char* key, double plain) {
                const auto found = offset.find(key);
                return found != offset.end() && found->second != Value(plain);
            };
            if (differs("offset", 0) || differs("scale", 1))
                note("the time offset of " + arc + ": its animation keeps its own times");
        }
        return Value(std::move(arc));
    }

    /// Relative to the folder of the first layer.
    std::string anchored(const std::string& asset) const {
        if (asset.empty() || asset[0] == '/' || asset.find("://") != asset.npos || folder_.empty())
            return asset;
        return (std::filesystem::path(folder_) / asset).lexically_normal().generic_string();
    }

    void note(const std::string& text) {
        cursor_.spend(text.size() + sizeof(std::string));
        layer_.notes.push_back(text);
    }

    // Prims

    UsdSpec readPrim(const std::string& parent, std::set<std::string>& names, int level) {
        if (level > deepestUsda)
            cursor_.refuse("expected at most " + std::to_string(deepestUsda) + " levels");
        UsdSpec spec;
        cursor_.spend(sizeof(UsdSpec) + 128);
        spec.line = cursor_.line();
        spec.prim.specifier = cursor_.word("def, over or class");
        const std::string& kind = spec.prim.specifier;
        if (kind != "def" && kind != "over" && kind != "class")
            cursor_.refuse("expected def, over or class, found \"" + kind + "\"");
        if (!cursor_.atString()) spec.prim.typeName = cursor_.word("a type or a name");
        spec.prim.name = cursor_.string("the name of a prim");
        if (!isName(spec.prim.name))
            cursor_.refuse("expected the name of a prim, found \"" + spec.prim.name + "\"");
        if (!names.insert(spec.prim.name).second)
            cursor_.refuse("expected a name that no sibling has, found \"" + spec.prim.name + "\"");
        const std::string path = parent + "/" + spec.prim.name;
        cursor_.setPath(path);
        readBody(spec, path, level);
        cursor_.setPath(parent);
        return spec;
    }

    /// Metadata and what stands between the braces, of a prim or a variant.
    void readBody(UsdSpec& spec, const std::string& path, int level) {
        if (cursor_.peek() == '(')
            readMetadata([&](const std::string& key, const std::string& op) { readPrimKey(spec, key, op); },
                         spec.prim.metadata);
        std::set<std::string> names;
        cursor_.expect('{');
        while (!cursor_.take('}')) {
            if (cursor_.take(';')) continue;
            if (cursor_.takeWord("variantSet"))
                spec.variantSets.push_back(readVariantSet(path, level + 1));
            else if (isSpecifier())
                spec.children.push_back(readPrim(path, names, level + 1));
            else
                readProperty(spec.prim, path);
        }
    }

    bool isSpecifier() { return cursor_.isNext("def") || cursor_.isNext("over") || cursor_.isNext("class"); }

    UsdVariantSet readVariantSet(const std::string& path, int level) {
        if (level > deepestUsda)
            cursor_.refuse("expected at most " + std::to_string(deepestUsda) + " levels");
        UsdVariantSet set;
        set.name = cursor_.string("the name of a variant set");
        cursor_.expect('=');
        cursor_.expect('{');
        while (!cursor_.take('}')) {
            UsdSpec variant;
            cursor_.spend(sizeof(UsdSpec) + 128);
            variant.prim.specifier = "over";
            variant.prim.name = cursor_.string("the name of a variant");
            variant.line = cursor_.line();
            readBody(variant, path, level);
            set.variants.push_back(std::move(variant));
        }
        return set;
    }

    // Properties

    void readProperty(Prim& prim, const std::string& path) {
        std::string op;
        for (const char* word : listOps)
            if (op.empty() && cursor_.takeWord(word)) op = word;
        if (op == "reorder" && (cursor_.takeWord("nameChildren") || cursor_.takeWord("properties"))) {
            cursor_.expect('=');
            parseUsdaValue(cursor_, 1);
            return;
        }
        Value::Object other;
        if (cursor_.takeWord("custom")) other["custom"] = Value(true);
        if (cursor_.takeWord("uniform")) other["variability"] = Value("uniform");
        if (!cursor_.takeWord("varying")) static_cast<void>(cursor_.takeWord("config"));
        std::string type = todaysUsdType(cursor_.word("a property, a prim or \"}\"", true));
        if (cursor_.take('[')) cursor_.expect(']'), type += "[]";
        const std::string name = cursor_.word("the name of a property", true);
        cursor_.spend(sizeof(Property) + 160 + name.size());
        cursor_.setPath(path + "." + name);
        Property& property = prim.properties[name];
        if (type == "rel")
            readRelationship(property, op);
        else
            readAttribute(property, type, op);
        for (auto& [key, value] : other) property.other[key] = value;
        cursor_.setPath(path);
    }

    void readRelationship(Property& property, const std::string& op) {
        if (!property.typeName.empty()) cursor_.refuse("expected one property of this name");
        if (!property.targetPaths) property.targetPaths = Value(Value::Array());
        if (cursor_.take('=')) {
            Value::Object holder{{"paths", *property.targetPaths}};
            addList(holder, "paths", op, readPaths());
            property.targetPaths = holder["paths"];
        }
        if (cursor_.peek() == '(') readPropertyMetadata(property);
    }

    Value::Array readPaths() {
        Value::Array paths;
        const auto one = [&] {
            cursor_.spend(sizeof(Value));
            paths.emplace_back(cursor_.absolutePath());
        };
        if (cursor_.takeWord("None")) return paths;
        if (!cursor_.take('[')) return one(), paths;
        while (!cursor_.take(']')) {
            one();
            if (!cursor_.take(',') && cursor_.peek() != ']') cursor_.refuseFound("\",\" or \"]\"");
        }
        return paths;
    }

    void readAttribute(Property& property, const std::string& type, const std::string& op) {
        if (property.targetPaths || (!property.typeName.empty() && property.typeName != type))
            cursor_.refuse("expected one property of this name, of one type");
        property.typeName = type;
        std::string field;
        if (cursor_.here() == '.') {
            cursor_.take('.');
            field = cursor_.word("timeSamples or connect");
        }
        if (field == "connect") {
            cursor_.expect('=');
            addList(property.other, "connectionPaths", op, readPaths());
        } else if (field == "timeSamples") {
            cursor_.expect('=');
            readSamples(property);
        } else if (field == "spline") {
            cursor_.refuse("splines are not read");
        } else if (!field.empty() && field != "default") {
            cursor_.refuse("expected timeSamples or connect, found \"" + field + "\"");
        } else if (cursor_.take('=')) {
            property.defaultValue = parseUsdaValue(cursor_, type, 1);
        }
        if (cursor_.peek() == '(') readPropertyMetadata(property);
    }

    void readPropertyMetadata(Property& property) {
        readMetadata(
            [&](const std::string& key, const std::string& op) { readPlain(key, op, property.other); },
            property.other);
    }

    void readSamples(Property& property) {
        std::vector<Property::Sample>& samples = property.timeSamples;
        if (!samples.empty()) cursor_.refuse("expected time samples once");
        cursor_.expect('{');
        while (!cursor_.take('}')) {
            Property::Sample sample;
            if (!cursor_.number(sample.time) || sample.time - sample.time != 0) cursor_.refuseFound("a time");
            cursor_.expect(':');
            cursor_.spend(sizeof(Property::Sample));
            sample.value = parseUsdaValue(cursor_, property.typeName, 1);
            samples.push_back(std::move(sample));
            if (!cursor_.take(',') && cursor_.peek() != '}') cursor_.refuseFound("\",\" or \"}\"");
        }
        const auto earlier = [](const auto& a, const auto& b) { return a.time < b.time; };
        std::ranges::stable_sort(samples, earlier);
        for (std::size_t i = 1; i < samples.size(); ++i)
            if (samples[i].time == samples[i - 1].time) cursor_.refuse("expected each time once");
    }

    UsdaCursor cursor_;
    std::string folder_;
    UsdLayer layer_;
};

} // namespace

std::string notUsda(std::string_view text, const std::string& first) {
    if (text.starts_with("PXR-USDC") || text.starts_with("PK\x03\x04"))
        return std::string("is a ") + (text[1] == 'X' ? "binary layer" : "package") +
               " of USD; expected text: usdcat --flatten -o scene.usda " + first + " makes one of all layers";
    if (!text.starts_with("#usda 1."))
        return "expected a layer of USD in text form, which begins with #usda 1.0";
    return "";
}

UsdLayer parseUsda(std::string_view text, const std::string& file, const std::string& folder,
                   UsdBudget& budget) {
    const auto refuse = [&](const std::string& message) { throw InputError(Where{file}, message); };
    if (const std::string problem = notUsda(text, file); !problem.empty()) refuse(problem);
    if (text.size() > budget.text) refuse("expected files of at most 128 MiB in all");
    budget.text -= text.size();
    if (!isUtf8(text) || text.find('\0') != text.npos) refuse("expected text in UTF-8");
    return Parser(text, file, folder, budget).parse();
}

} // namespace tss
