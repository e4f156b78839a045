#include "bake/base/Words.h"
#include "bake/scene/SceneParts.h"

#include <algorithm>
#include <sstream>

namespace tss {

namespace {

/// UsdPhysics' properties that osgTSS does not read, behind "physics:".
constexpr const char* otherPhysics =
    "approximation mass density centerOfMass diagonalInertia principalAxes breakForce breakTorque "
    "excludeFromArticulation minDistance maxDistance dynamicFriction staticFriction restitution "
    "gravityDirection gravityMagnitude rigidBodyEnabled kinematicEnabled simulationOwner startsAsleep "
    "velocity angularVelocity filteredPairs filteredGroups invertFilteredGroups mergeGroup";

/// Ours and UsdPhysics', as they stand in a file.
const std::vector<std::string>& knownNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const SchemaType& type : schemaTypes())
            for (const Attribute& attribute : type.attributes)
                if (attribute.name.find(':') != attribute.name.npos) all.emplace_back(attribute.name);
        std::istringstream words(otherPhysics);
        for (std::string word; words >> word;) all.push_back("physics:" + word);
        return all;
    }();
    return names;
}

void remark(const std::string& name, const std::string& part, const std::vector<std::string>& known,
            const Place& place, Problems& problems) {
    constexpr std::size_t longest = 64;
    if (std::ranges::find(known, part) != known.end() || name.size() > longest) return;
    const std::string wanted = lowerCase(part); // case does not count
    const std::string* nearest = nullptr;
    std::size_t least = std::max<std::size_t>(2, part.size() / 5) + 1;
    for (const std::string& candidate : known)
        if (const std::size_t d = editDistance(wanted, lowerCase(candidate)); d < least)
            least = d, nearest = &candidate;
    if (nearest)
        problems.warn(place, "no property of this name is read; perhaps ",
                      name.substr(0, name.size() - part.size()), *nearest, " was meant");
    else if (name.starts_with("tss:"))
        problems.warn(place, "no property of this name is read");
}

void remark(const std::string& name, const Place& place, Problems& problems) {
    static const std::vector<std::string> ofLimits = {"low", "high"},
                                          ofDrives = {"targetPosition", "targetVelocity", "stiffness",
                                                      "damping",        "maxForce",       "type"};
    if (name.starts_with(schema::bakePrefix) || name.starts_with("tss:drive:")) return;
    const auto behind = name.rfind(":physics:");
    if (behind != name.npos && (name.starts_with("limit:") || name.starts_with("drive:")))
        remark(name, name.substr(behind + 9), name[0] == 'l' ? ofLimits : ofDrives, place, problems);
    else if (name.starts_with("tss:") || name.starts_with("physics:") || name.starts_with("primvars:tss:") ||
             name.starts_with("primvars:skel:"))
        remark(name, name, knownNames(), place, problems);
}

bool hasHoles(const std::string& type, const std::string& name, const Property& property) {
    return type == "Mesh" && name == "holeIndices" && property.defaultValue &&
           *property.defaultValue != Value(Value::Array());
}

void remark(const std::vector<Prim>& prims, const Place& place, Problems& problems) {
    for (std::size_t i = 0; i < prims.size(); ++i) {
        const Place at = place.child(i, prims[i].name);
        for (const auto& [name, property] : prims[i].properties) {
            remark(name, at.property(name), problems);
            if (hasHoles(prims[i].typeName, name, property))
                problems.warn(at.property(name), "not read: faces that are holes are surface too; what is "
                                                 "proven holds, contact may be reported in them");
        }
        remark(prims[i].children, at, problems);
    }
}

} // namespace

const std::vector<SchemaType>& schemaTypes() {
    static const std::vector<SchemaType> all = [] {
        std::vector<SchemaType> types;
        for (const auto& some :
             {bodySchemas(), jointSchemas(), pairSchemas(), tableSchemas(), muscleSchemas(), skinSchemas()})
            types.insert(types.end(), some.begin(), some.end());
        return types;
    }();
    return all;
}

void remarkTypos(const Layer& layer, Problems& problems) {
    remark(layer.children, {}, problems);
}

} // namespace tss
