#include "bake/scene/WriteUsda.h"

#include "bake/scene/Schema.h"
#include "bake/scene/UsdaText.h"
#include "bake/scene/WriteLayer.h"

#include <algorithm>
#include <array>

namespace tss {

namespace {

/// Metadata that the text form knows by name, with the type of its value ("list": a list op, "dictionary").
struct Known {
    const char* key;
    const char* type;
    const char* word = nullptr; ///< when .usda calls it something else
};

constexpr std::array layerMetadata = {Known{"defaultPrim", "token"},
                                      Known{"metersPerUnit", "double"},
                                      Known{"kilogramsPerUnit", "double"},
                                      Known{"upAxis", "token"},
                                      Known{"timeCodesPerSecond", "double"},
                                      Known{"framesPerSecond", "double"},
                                      Known{"startTimeCode", "double"},
                                      Known{"endTimeCode", "double"},
                                      Known{"comment", "string"},
                                      Known{"documentation", "string", "doc"},
                                      Known{"customLayerData", "dictionary"}};
constexpr std::array primMetadata = {Known{"references", "references"},
                                     Known{"apiSchemas", "list"},
                                     Known{"kind", "token"},
                                     Known{"active", "bool"},
                                     Known{"instanceable", "bool"},
                                     Known{"hidden", "bool"},
                                     Known{"displayName", "string"},
                                     Known{"comment", "string"},
                                     Known{"assetInfo", "dictionary"},
                                     Known{"customData", "dictionary"},
                                     Known{"documentation", "string", "doc"}};
constexpr std::array propertyMetadata = {
    Known{"interpolation", "token"},   Known{"elementSize", "int"},
    Known{"hidden", "bool"},           Known{"displayName", "string"},
    Known{"displayGroup", "string"},   Known{"comment", "string"},
    Known{"customData", "dictionary"}, Known{"documentation", "string", "doc"}};

class UsdaWriter {
public:
    std::string out = "#usda 1.0\n";

    void write(const Layer& layer) {
        Value::Object all = layer.metadata;
        // Said even where they are what they are when absent: stages of other programs fall back to others.
        all.try_emplace("metersPerUnit", 0.01);
        all.try_emplace("upAxis", "Y");
        if (!layer.children.empty()) all.try_emplace("defaultPrim", layer.children.front().name);
        if (!layer.other.empty()) keepUnknown(all, "customLayerData", usda::unknownKeys, layer.other);
        Value& data = all["customLayerData"];
        if (data.isNull()) data = Value(Value::Object());
        if (auto* dictionary = data.as<Value::Object>())
            (*dictionary)[usda::mark] = Value(layer.formatVersion);
        metadata(all, layerMetadata, "customLayerData");
        for (const Prim& prim : layer.children) {
            out += '\n';
            write(prim);
        }
    }

private:
    void line(const std::string& text) {
        out.append(indent_, ' ');
        out += text;
    }

    /// What has no word of its own goes as JSON text into a dictionary that has one.
    static void keepUnknown(Value::Object& metadata, const char* dictionary, const char* key,
                            const Value::Object& unknown) {
        Value& data = metadata[dictionary];
        if (!data.as<Value::Object>()) data = Value(Value::Object());
        (*data.as<Value::Object>())[key] = Value(jsonText(Value(unknown)));
    }

    template <class Table>
    static const Known* find(const Table& known, const std::string& key, const Value& value) {
        for (const Known& entry : known) {
            if (key != entry.key) continue;
            const std::string type = entry.type;
            if (type == "list" || type == "references")
                return value.as<Value::Array>() || value.as<Value::Object>() ? &entry : nullptr;
            if (type == "dictionary") return value.as<Value::Object>() ? &entry : nullptr;
            if (type == "bool") return value.as<bool>() ? &entry : nullptr;
            if (type == "token" || type == "string") return value.as<std::string>() ? &entry : nullptr;
            return value.as<double>() ? &entry : nullptr;
        }
        return nullptr;
    }

    /// A list of names or, for references, of paths of this layer.
    void listOp(const std::string& word, const Value& value, bool paths) {
        for (const auto& [op, list] : listOps(value)) {
            line(op + word + " = [");
            for (std::size_t i = 0; i < list.size(); ++i) {
                if (i > 0) out += ", ";
                if (paths)
                    out += "<" + list[i] + ">";
                else
                    appendUsdaString(out, list[i]);
            }
            out += "]\n";
        }
    }

    /// The operations of a list op with the words before them, as OpenUSD reads them: items once in each,
    /// only an explicit list may be empty, and beside it there are no others.
    static std::vector<std::pair<std::string, std::vector<std::string>>> listOps(const Value& value) {
        const auto once = [](const Value& list) {
            std::vector<std::string> items;
            for (const std::string& item : listItems(list))
                if (std::ranges::find(items, item) == items.end()) items.push_back(item);
            return items;
        };
        const auto* ops = value.as<Value::Object>();
        if (!ops || ops->contains("explicit")) return {{"", once(value)}};
        std::vector<std::pair<std::string, std::vector<std::string>>> all;
        for (const auto& [op, list] : *ops)
            if (auto items = once(list); !items.empty()) all.emplace_back(op + " ", std::move(items));
        return all;
    }

    template <class Table>
    void metadata(Value::Object all, const Table& known, const char* dictionary) {
        Value::Object unknown;
        for (auto it = all.begin(); it != all.end();) {
            if (find(known, it->first, it->second)) {
                ++it;
                continue;
            }
            unknown.insert(std::move(*it));
            it = all.erase(it);
        }
        if (!unknown.empty()) keepUnknown(all, dictionary, usda::unknownMetadata, unknown);
        if (all.empty()) return;
        out.pop_back(); // the line break: the parenthesis follows on the same line, except after the first
                        // line
        out += out == "#usda 1.0" ? "\n(\n" : " (\n";
        indent_ += 4;
        for (const auto& [key, value] : all) entry(*find(known, key, value), value);
        indent_ -= 4;
        line(")\n");
    }

    void entry(const Known& known, const Value& value) {
        const std::string word = known.word ? known.word : known.key, type = known.type;
        if (word == "comment") { // which has no word: a string on its own
            line("");
            appendUsdaString(out, *value.as<std::string>());
            out += '\n';
            return;
        }
        if (type == "list" || type == "references") return listOp(word, value, type == "references");
        line(word + " = ");
        if (type == "dictionary")
            appendUsdaDictionary(out, *value.as<Value::Object>(), indent_);
        else if (type == "bool")
            out += *value.as<bool>() ? "true" : "false";
        else
            appendUsda(out, value, *valueType(type));
        out += '\n';
    }

    void write(const Prim& prim) {
        line(prim.specifier + (prim.typeName.empty() ? "" : " " + prim.typeName) + " \"" + prim.name +
             "\"\n");
        Value::Object all = prim.metadata;
        if (!prim.other.empty()) keepUnknown(all, "customData", usda::unknownKeys, prim.other);
        metadata(all, primMetadata, "customData");
        line("{\n");
        indent_ += 4;
        writeProperties(prim);
        for (const Prim& child : prim.children) {
            if (&child != &prim.children.front() || !prim.properties.empty()) out += '\n';
            write(child);
        }
        indent_ -= 4;
        line("}\n");
    }

    void writeProperties(const Prim& prim) {
        // Other programs would round what has no such word; the faces are what osgTSS has proven.
        static const std::string scheme(schema::subdivisionScheme.name);
        bool missing = prim.typeName == "Mesh" && prim.specifier != "over";
        const auto writeScheme = [&] {
            Property none;
            none.typeName = schema::subdivisionScheme.typeName;
            none.defaultValue = Value("none");
            none.other["variability"] = Value("uniform");
            write(scheme, none);
            missing = false;
        };
        for (const auto& [name, property] : prim.properties) {
            if (missing && name >= scheme) {
                writeScheme();
                if (name == scheme) continue;
            }
            write(name, property);
        }
        if (missing) writeScheme();
    }

    void write(const std::string& name, const Property& property) {
        Value::Object all = property.other;
        std::string prefix;
        const auto take = [&](const char* key, const Value& value, const char* word) {
            const auto found = all.find(key);
            if (found == all.end() || found->second != value) return;
            all.erase(found);
            prefix += word;
        };
        take("custom", Value(true), "custom ");
        take("custom", Value(false), "");
        take("variability", Value("uniform"), property.isRelationship() ? "" : "uniform "); // as they all are
        take("variability", Value("varying"), "");
        if (property.isRelationship()) {
            relationship(prefix, name, *property.targetPaths, all);
        } else if (const ValueType* const type = valueType(property.typeName)) {
            attribute(prefix, name, property, *type, all);
        } else {
            line("custom string " + name + " = ");
            appendUsdaString(out, unknownText(property));
            out += '\n';
        }
    }

    /// An attribute of a type that USD does not have.
    static std::string unknownText(const Property& property) {
        Value::Object object = property.other;
        object["typeName"] = Value(property.typeName);
        if (property.defaultValue) object["default"] = *property.defaultValue;
        Value::Array samples;
        for (const auto& sample : property.timeSamples)
            samples.push_back(Value(Value::Array{Value(sample.time), sample.value}));
        if (!samples.empty()) object["timeSamples"] = Value(std::move(samples));
        return jsonText(Value(std::move(object)));
    }

    void relationship(const std::string& prefix, const std::string& name, const Value& paths,
                      const Value::Object& rest) {
        const auto ops = listOps(paths);
        const bool plain = ops.size() == 1 && ops.front().first.empty();
        if (!plain && (ops.empty() || !rest.empty())) { // metadata stands behind the name alone
            line(prefix + "rel " + name + "\n");
            metadata(rest, propertyMetadata, "customData");
        }
        for (const auto& [op, targets] : ops) {
            line(op + prefix + "rel " + name + " = ");
            if (targets.size() != 1) out += '[';
            for (std::size_t i = 0; i < targets.size(); ++i) out += (i > 0 ? ", <" : "<") + targets[i] + ">";
            if (targets.size() != 1) out += ']';
            out += '\n';
            if (plain) metadata(rest, propertyMetadata, "customData");
        }
    }

    void attribute(const std::string& prefix, const std::string& name, const Property& property,
                   const ValueType& type, const Value::Object& rest) {
        const std::string head = prefix + property.typeName + " " + name;
        if (property.defaultValue || property.timeSamples.empty() || !rest.empty()) {
            line(head);
            if (property.defaultValue) {
                out += " = ";
                appendUsda(out, *property.defaultValue, type);
            }
            out += '\n';
            metadata(rest, propertyMetadata, "customData");
        }
        if (property.timeSamples.empty()) return;
        line(head + ".timeSamples = {\n");
        for (const Property::Sample& sample : property.timeSamples) {
            line("    ");
            appendNumber(out, sample.time);
            out += ": ";
            appendUsda(out, sample.value, type);
            out += ",\n";
        }
        line("}\n");
    }

    std::size_t indent_ = 0;
};

} // namespace

std::string writeUsda(const Layer& layer) {
    UsdaWriter writer;
    writer.write(layer);
    return std::move(writer.out);
}

} // namespace tss
