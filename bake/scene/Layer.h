#pragma once
#include "bake/scene/Value.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tss {

/// An attribute (typeName, default, time samples) or a relationship (targetPaths) of a prim.
struct Property {
    struct Sample {
        double time = 0;
        Value value; ///< null blocks
        friend bool operator==(const Sample&, const Sample&) = default;
    };

    std::string typeName;              ///< of an attribute, empty for a relationship
    std::optional<Value> defaultValue; ///< null blocks
    std::vector<Sample> timeSamples;   ///< times strictly rising
    std::optional<Value> targetPaths;  ///< of a relationship: an array of paths, or a list op
    Value::Object other;               ///< variability, interpolation and every key that osgTSS does not know

    bool isRelationship() const { return targetPaths.has_value(); }
    friend bool operator==(const Property&, const Property&) = default;
};

/// A node of the scene tree.
struct Prim {
    std::string specifier = "def"; ///< def, over or class
    std::string typeName;          ///< Mesh, Xform, ...; may be empty
    std::string name;              ///< [A-Za-z_][A-Za-z0-9_]*
    Value::Object metadata;
    std::map<std::string, Property> properties;
    std::vector<Prim> children; ///< in the order of the file
    Value::Object other;        ///< keys that osgTSS does not know

    const Property* property(std::string_view name) const;
    const Prim* child(std::string_view name) const;
    friend bool operator==(const Prim&, const Prim&) = default;
};

/// The tree of a scene file, in USD's terms (a Sdf layer), with everything that osgTSS does not know.
struct Layer {
    std::string formatVersion = "1.0";
    Value::Object metadata;
    std::vector<Prim> children;
    Value::Object other;

    friend bool operator==(const Layer&, const Layer&) = default;
};

/// The prim at an absolute path such as /Jaw/Hinge, null when there is none.
const Prim* findPrim(const Layer& layer, std::string_view path);
Prim* findPrim(Layer& layer, std::string_view path);

/// The prim at this path; it and its parents are made, as prims of this type and as Xform, where they are
/// missing.
Prim& makePrim(Layer& layer, std::string_view path, const std::string& typeName);

/// Takes the prim and everything below it away. Nothing happens when there is none.
void removePrim(Layer& layer, std::string_view path);

/// The items of an array of strings, or of a list op: explicit ones, or prepended, added and appended ones.
std::vector<std::string> listItems(const Value& value);

/// The prim has this API schema, with its instance name for a multiple-apply one: "PhysicsDriveAPI:rotX".
bool hasApi(const Prim& prim, std::string_view api);

/// Prepends the schema to the prim's list unless it has it.
void addApi(Prim& prim, const std::string& api);

/// Children of a weaker prim under those of a stronger one: two of one name become one, merge(stronger,
/// weaker), in the weaker one's place; what the stronger one alone has comes behind.
template <class Child, class Name, class Merge>
void mergeChildren(std::vector<Child>& stronger, std::vector<Child> weaker, const Name& name,
                   const Merge& merge) {
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < weaker.size(); ++i) places[name(weaker[i])] = i;
    for (Child& child : stronger) {
        const auto same = places.find(name(child));
        if (same == places.end()) {
            weaker.push_back(std::move(child));
        } else {
            merge(child, std::move(weaker[same->second]));
            weaker[same->second] = std::move(child);
        }
    }
    stronger = std::move(weaker);
}

/// How many numbers, or other single values, the property has in all.
std::size_t numbersIn(const Property& property);

/// A name that USD accepts: [A-Za-z_][A-Za-z0-9_]*
bool isPrimName(std::string_view name);

} // namespace tss
