#include "bake/usd/UsdParts.h"

#include <algorithm>

namespace tss {

namespace {

constexpr Attribute filteredPairs{"physics:filteredPairs", "rel"},
    filteredGroups{"physics:filteredGroups", "rel"}, mergeGroup{"physics:mergeGroup", "string"},
    inverted{"physics:invertFilteredGroups", "bool"}, includes{"collection:colliders:includes", "rel"},
    excludes{"collection:colliders:excludes", "rel"}, includeRoot{"collection:colliders:includeRoot", "bool"},
    expansionRule{"collection:colliders:expansionRule", "token"};

bool isGroupPrim(const Prim& prim) {
    return prim.typeName == "PhysicsCollisionGroup";
}

/// A shape of a link and what it is in: collision groups, merged ones as one, and what filtered pairs name.
struct FilteredShape {
    int link, entry, collider;
    std::set<int> groups;
};

/// Groups that one filters: those that it names, or of the collision groups all others.
struct FilterRule {
    std::set<int> named;
    bool others = false;
};

/// What collision groups say of a prim, by their places in the file.
struct NamedMembers {
    std::vector<int> excluded, included, alone; ///< alone: without what is below it
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
        if (rules_.empty()) return found;
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
        struct Group {
            int number; ///< of merged ones the same
            bool others;
            std::vector<std::string> filtered;
        };
        std::vector<Group> groups;
        std::map<std::string, int> numbers, merged; // by path, by the name they are merged under
        forThose(isGroupPrim, "left out: collision groups that cannot be read", [&](const PrimReader& prim) {
            Group group{groups_, prim.flag(inverted, false), prim.targets(filteredGroups)};
            const bool merges = prim.has(mergeGroup);
            const std::string name = prim.text(mergeGroup);
            readMembers(prim, static_cast<int>(groups.size())); // what cannot be read has ended this by here
            if (merges) group.number = merged.try_emplace(name, groups_).first->second;
            groups_ = std::max(groups_, group.number + 1);
            numbers[prim.place().path] = group.number;
            groups.push_back(std::move(group));
        });
        collisionGroups_ = groups_;
        for (const Group& group : groups) {
            FilterRule& rule = rules_[group.number].emplace_back();
            rule.others = group.others;
            for (const std::string& path : group.filtered)
                if (const auto at = numbers.find(path); at != numbers.end()) rule.named.insert(at->second);
        }
        for (FilteredShape& shape : shapes_)
            for (const int group : groupsOf(pathOf(shape.collider)))
                shape.groups.insert(groups[group].number);
    }

    /// With fewer members than in the file fewer pairs are left out, none that should not be.
    void readMembers(const PrimReader& prim, int group) {
        const auto in = prim.targets(includes), out = prim.targets(excludes);
        const bool all = prim.flag(includeRoot, false), expands = prim.text(expansionRule) != "explicitOnly";
        const auto isOther = [](const std::string& path) { return path.find('.') != path.npos; };
        const bool less = std::ranges::any_of(out, isOther);
        if (less || std::ranges::any_of(in, isOther) ||
            prim.prim().property("collection:colliders:membershipExpression"))
            leftOut_.add("left out: members of collision groups that other collections or expressions name",
                         prim.place().path);
        if (less) return;
        for (const std::string& path : out) members_[path].excluded.push_back(group);
        for (const std::string& path : in)
            (expands ? members_[path].included : members_[path].alone).push_back(group);
        if (all) all_.push_back(group);
    }

    /// As a UsdCollectionAPI has it: of a prim and those above it the nearest that a group names decides.
    std::set<int> groupsOf(const std::string& path) const {
        std::set<int> decided, in;
        const auto decide = [&](const std::vector<int>& groups, bool member) {
            for (const int group : groups)
                if (decided.insert(group).second && member) in.insert(group);
        };
        for (std::string at = path; !at.empty(); at.erase(at.rfind('/'))) {
            const auto named = members_.find(at);
            if (named == members_.end()) continue;
            decide(named->second.excluded, false);
            decide(named->second.included, true);
            if (at == path) decide(named->second.alone, true);
        }
        decide(all_, true);
        return in;
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
                    rules_[a].push_back({{b}, false});
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

    bool filters(int one, int other) const {
        const auto rules = rules_.find(one);
        return rules != rules_.end() && std::ranges::any_of(rules->second, [&](const FilterRule& rule) {
                   return rule.named.contains(other) != (rule.others && other < collisionGroups_);
               });
    }

    bool areOff(const std::set<int>& one, const std::set<int>& other) const {
        for (const int a : one)
            for (const int b : other)
                if (filters(a, b) || filters(b, a)) return true;
        return false;
    }

    const std::string& pathOf(int entry) const { return reading_.index.entries[entry].place.path; }

    const SceneReading& reading_;
    const std::vector<int>& linkOf_;
    LeftOut& leftOut_;
    std::vector<FilteredShape> shapes_;
    int groups_ = 0, collisionGroups_ = 0;
    std::map<int, int> own_; ///< by entry that a filtered pair names: its group
    std::map<int, std::vector<FilterRule>> rules_;
    std::map<std::string, NamedMembers> members_; ///< by path
    std::vector<int> all_;                        ///< groups of all prims but those that they exclude
};

} // namespace

FilteredLinks filteredLinks(const SceneReading& reading, const Colliders& colliders,
                            const std::vector<int>& linkOf, LeftOut& leftOut) {
    return Filters(reading, colliders, linkOf, leftOut).links();
}

} // namespace tss
