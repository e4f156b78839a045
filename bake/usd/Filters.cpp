#include "bake/usd/UsdParts.h"

#include <algorithm>

namespace tss {

namespace {

constexpr Attribute filteredPairs{"physics:filteredPairs", "rel"},
    filteredGroups{"physics:filteredGroups", "rel"}, mergeGroup{"physics:mergeGroup", "string"},
    inverted{"physics:invertFilteredGroups", "bool"}, includes{"collection:colliders:includes", "rel"},
    excludes{"collection:colliders:excludes", "rel"}, includeRoot{"collection:colliders:includeRoot", "bool"},
    expansionRule{"collection:colliders:expansionRule", "token"};

using Paths = std::set<std::string>;

/// Prims as a UsdCollectionAPI has them: of a prim and those above it the nearest that is named decides.
struct Collection {
    Paths included, excluded;
    bool expands = true; ///< what is below an included prim is in it too
    bool all = false;    ///< all prims are, but for the excluded

    bool holds(const std::string& path) const {
        for (std::string at = path; !at.empty(); at.erase(at.rfind('/'))) {
            if (excluded.contains(at)) return false;
            if (included.contains(at) && (expands || at == path)) return true;
        }
        return all;
    }
};

Paths pathsAt(const PrimReader& prim, const Attribute& relationship) {
    const auto targets = prim.targets(relationship);
    return {targets.begin(), targets.end()};
}

bool isGroupPrim(const Prim& prim) {
    return prim.typeName == "PhysicsCollisionGroup";
}

/// A shape of a link and what it is in: collision groups, merged ones as one, and what filtered pairs name.
struct FilteredShape {
    int link, entry, collider;
    std::set<int> groups;
};

class Filters {
public:
    Filters(const SceneReading& reading, const Colliders& colliders, const std::vector<int>& linkOf,
            LeftOut& leftOut)
        : reading_(reading), linkOf_(linkOf), leftOut_(leftOut) {
        listShapes(colliders);
        readGroups();
        readPairs();
    }

    FilteredLinks links() const {
        FilteredLinks found;
        if (off_.empty()) return found;
        std::map<int, std::set<std::set<int>>> kinds; // by link; many shapes are in the same groups
        for (const FilteredShape& shape : shapes_) kinds[shape.link].insert(shape.groups);
        for (auto a = kinds.begin(); a != kinds.end(); ++a)
            for (auto b = std::next(a); b != kinds.end(); ++b) {
                bool any = false, all = true;
                for (auto one = a->second.begin(); one != a->second.end() && (all || !any); ++one)
                    for (const std::set<int>& other : b->second) {
                        const bool off = areOff(*one, other);
                        any = any || off;
                        all = all && off;
                    }
                if (any) (all ? found.wholly : found.partly).emplace_back(a->first, b->first);
            }
        return found;
    }

private:
    /// Those that collide; all of a link that has none of these, since they are taken in their place.
    void listShapes(const Colliders& colliders) {
        std::set<int> collide;
        const auto each = [&](const auto& visit) {
            for (std::size_t i = 0; i < linkOf_.size(); ++i)
                if (isGprim(*reading_.index.entries[i].prim) && !colliders.isPrototype(i))
                    visit(static_cast<int>(i), colliders.collides(i));
        };
        each([&](int entry, bool collides) {
            if (collides) collide.insert(linkOf_[entry]);
        });
        each([&](int entry, bool collides) {
            const int link = linkOf_[entry];
            if (collides || (link >= 0 && !collide.contains(link)))
                shapes_.push_back({link, entry, collides ? colliders.colliderOf(entry) : entry, {}});
        });
    }

    void readGroups() {
        std::map<std::string, int> numbers, merged; // by path, by the name they are merged under
        std::map<std::string, bool> inversion;      // by path: those groups are meant that are not named
        std::map<std::string, Paths> named;
        forThose(isGroupPrim, "left out: collision groups that cannot be read", [&](const PrimReader& prim) {
            const std::string& path = prim.place().path;
            const Collection members = membersOf(prim);
            named[path] = pathsAt(prim, filteredGroups);
            inversion[path] = prim.flag(inverted, false);
            const int number = prim.has(mergeGroup)
                                   ? merged.try_emplace(prim.text(mergeGroup), groups_).first->second
                                   : groups_;
            groups_ = std::max(groups_, number + 1);
            numbers[path] = number;
            for (FilteredShape& shape : shapes_)
                if (members.holds(pathOf(shape.collider))) shape.groups.insert(number);
        });
        for (const auto& [path, number] : numbers) {
            std::set<int> those;
            for (const std::string& other : named[path])
                if (numbers.contains(other)) those.insert(numbers[other]);
            for (int group = 0; group < groups_; ++group)
                if (those.contains(group) != inversion[path]) switchOff(number, group);
        }
    }

    /// With fewer members than in the file fewer pairs are left out, none that should not be.
    Collection membersOf(const PrimReader& prim) {
        Collection members;
        members.included = pathsAt(prim, includes);
        members.excluded = pathsAt(prim, excludes);
        members.all = prim.flag(includeRoot, false);
        members.expands = prim.text(expansionRule) != "explicitOnly";
        const auto isOther = [](const std::string& path) { return path.find('.') != path.npos; };
        const bool less = std::ranges::any_of(members.excluded, isOther);
        if (less || std::ranges::any_of(members.included, isOther) ||
            prim.prim().property("collection:colliders:membershipExpression"))
            leftOut_.add("left out: members of collision groups that other collections or expressions name",
                         prim.place().path);
        return less ? Collection() : members;
    }

    void readPairs() {
        const auto wanted = [](const Prim& prim) { return hasApi(prim, "PhysicsFilteredPairsAPI"); };
        const char* const left =
            "left out: filtered pairs that are not of bodies or colliders, so that they stay on";
        forThose(wanted, left, [&](const PrimReader& prim) {
            const int a = groupOf(reading_.index.find(prim.place().path));
            for (const std::string& path : prim.targets(filteredPairs)) {
                const int b = groupOf(reading_.index.find(path));
                if (a >= 0 && b >= 0)
                    switchOff(a, b);
                else
                    leftOut_.add(left, prim.place().path);
            }
        });
    }

    /// One that cannot be read costs itself alone.
    template <class Wanted, class Visit>
    void forThose(const Wanted& wanted, const char* left, const Visit& visit) {
        reading_.forPrims(wanted, [&](const PrimReader& prim, int) {
            try {
                visit(prim);
            } catch (const InputError& error) {
                const std::string& path = prim.place().path;
                leftOut_.add(left, path + " (" + messageBelow(path, error) + ")");
            }
        });
    }

    /// A group of all shapes of a body or a collider, and of no others; -1 for what is neither.
    int groupOf(int entry) {
        if (entry < 0) return -1;
        const int link = linkOf_[entry], parent = reading_.index.entries[entry].parent;
        const bool body = link >= 0 && (parent < 0 || linkOf_[parent] != link);
        const auto holds = [&](const FilteredShape& shape) {
            return body ? shape.link == link : shape.collider == entry || shape.entry == entry;
        };
        if (!body && std::ranges::none_of(shapes_, holds)) return -1;
        const auto [at, added] = own_.try_emplace(entry, groups_);
        if (added) ++groups_;
        for (FilteredShape& shape : shapes_)
            if (added && holds(shape)) shape.groups.insert(at->second);
        return at->second;
    }

    void switchOff(int a, int b) { off_.insert(std::minmax(a, b)); }

    bool areOff(const std::set<int>& one, const std::set<int>& other) const {
        for (const int a : one)
            for (const int b : other)
                if (off_.contains(std::minmax(a, b))) return true;
        return false;
    }

    const std::string& pathOf(int entry) const { return reading_.index.entries[entry].place.path; }

    const SceneReading& reading_;
    const std::vector<int>& linkOf_;
    LeftOut& leftOut_;
    std::vector<FilteredShape> shapes_;
    int groups_ = 0;
    std::map<int, int> own_;            ///< by entry that a filtered pair names: its group
    std::set<std::pair<int, int>> off_; ///< groups that do not collide with each other, or in themselves
};

} // namespace

FilteredLinks filteredLinks(const SceneReading& reading, const Colliders& colliders,
                            const std::vector<int>& linkOf, LeftOut& leftOut) {
    return Filters(reading, colliders, linkOf, leftOut).links();
}

} // namespace tss
