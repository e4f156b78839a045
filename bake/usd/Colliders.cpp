#include "bake/usd/UsdParts.h"

#include <algorithm>
#include <array>

namespace tss {

namespace {

constexpr Attribute enabled{"physics:collisionEnabled", "bool"}, prototypes{"prototypes", "rel"};

} // namespace

bool isGroup(const Prim& prim) {
    static constexpr std::array types = {"", "Xform", "Scope"};
    return std::ranges::find(types, prim.typeName) != types.end();
}

Colliders::Colliders(const SceneReading& reading) : reading_(reading) {
    const std::vector<PrimEntry>& entries = reading.index.entries;
    holds_.assign(entries.size(), None);
    for (std::size_t i = entries.size(); i-- > 0;) { // parents come first
        if (hasApi(*entries[i].prim, "PhysicsCollisionAPI")) holds_[i] = Own;
        if (const int parent = entries[i].parent; parent >= 0 && holds_[i] != None)
            holds_[static_cast<std::size_t>(parent)] = Below; // its own is seen when it is come to
    }
}

bool Colliders::collides(std::size_t entry) const {
    const int at = colliderOf(entry);
    return at >= 0 && reading_.reader(at).flag(enabled, true);
}

int Colliders::colliderOf(std::size_t entry) const {
    const std::vector<PrimEntry>& entries = reading_.index.entries;
    for (int at = static_cast<int>(entry); at >= 0; at = entries[at].parent) {
        const bool counts = at == static_cast<int>(entry) || !isGprim(*entries[at].prim);
        if (counts && is(static_cast<std::size_t>(at))) return at;
    }
    return -1;
}

bool Colliders::isPrototype(std::size_t entry) const {
    const std::vector<PrimEntry>& entries = reading_.index.entries;
    for (int at = entries[entry].parent; at >= 0; at = entries[at].parent)
        if (entries[at].prim->typeName == "PointInstancer") return true;
    return false;
}

bool Colliders::hasCollidingPrototypes(std::size_t instancer) const {
    if (holds_[instancer] != None) return true;
    const auto paths = reading_.reader(static_cast<int>(instancer)).targets(prototypes);
    return std::ranges::any_of(paths, [&](const std::string& path) {
        const int entry = reading_.index.find(path);
        return entry >= 0 && holds_[static_cast<std::size_t>(entry)] != None;
    });
}

} // namespace tss
