#include "bake/usd/PrimSites.h"

#include <algorithm>
#include <tuple>

namespace tss {

namespace {

constexpr std::size_t mostArcs = 64, mostOfPrim = 200'000, mostSites = 20'000'000;

bool isUnder(const std::string& path, const std::string& root) {
    return path.starts_with(root) &&
           (path.size() == root.size() || path[root.size()] == '/' || path[root.size()] == '.');
}

std::size_t depthOf(const std::string& path) {
    return static_cast<std::size_t>(std::ranges::count(path, '/'));
}

/// A path of the site in that above it.
std::optional<std::string> inAbove(const PrimSite& site, const std::string& path) {
    if (isUnder(path, site.from)) return site.to + path.substr(site.from.size());
    if (!site.others || isUnder(path, site.to)) return std::nullopt;
    return path;
}

bool saysAnything(const PrimSite& site) {
    return site.spec || std::ranges::any_of(site.below, [](const auto& one) { return saysAnything(*one); });
}

bool isClassArc(UsdArc arc) {
    return arc == UsdArc::Inherit || arc == UsdArc::Specialize;
}

bool holds(const PrimSite& site, const UsdLayer* layer, const std::string& path) {
    return (site.layer == layer && site.path == path) ||
           std::ranges::any_of(site.below, [&](const auto& one) { return holds(*one, layer, path); });
}

/// As in Pcp no class counts twice.
bool speaksAlready(const PrimSite& site, const std::string& path) {
    const PrimSite* root = &site;
    while (root->above) root = root->above;
    return holds(*root, site.layer, path);
}

/// The name of a class above: out of what an arc brings along it is one everywhere.
std::string nameAbove(const PrimSite& site, const std::string& path) {
    return inAbove(site, path).value_or(path);
}

/// The classes that arcs of the site and of the weaker ones lead to, by their names there.
std::vector<std::pair<std::string, UsdArc>> classesOf(const PrimSite& site) {
    std::vector<std::pair<std::string, UsdArc>> classes;
    for (const auto& below : site.below) {
        if (isClassArc(below->arc)) {
            classes.emplace_back(below->path, below->arc);
            continue;
        }
        for (const auto& [path, arc] : classesOf(*below)) classes.emplace_back(nameAbove(*below, path), arc);
    }
    return classes;
}

/// The selection of a set that the strongest place has.
const std::string* selected(const PrimSite& site, const std::string& set) {
    if (site.spec) {
        if (const auto* all = member<Value::Object>(site.spec->prim.metadata, "variantSelection"))
            if (const auto found = all->find(set); found != all->end())
                return found->second.as<std::string>();
    }
    for (const auto& below : site.below)
        if (const std::string* found = selected(*below, set)) return found;
    return nullptr;
}

} // namespace

std::optional<std::string> inStage(const PrimSite& site, const std::string& path) {
    std::optional<std::string> at = path;
    for (const PrimSite* one = &site; one->above && at; one = one->above) at = inAbove(*one, *at);
    return at;
}

std::unique_ptr<PrimSite> PrimSites::top(const UsdLayer& layer, const std::string& name) {
    ofPrim_ = 0;
    auto site = siteOf(layer, "/" + name);
    chooseVariants(*site);
    return site;
}

std::unique_ptr<PrimSite> PrimSites::child(const PrimSite& prim, const std::string& name, bool ownBelow) {
    ofPrim_ = 0;
    auto site = extended(prim, name, nullptr);
    if (!ownBelow) site->spec = nullptr;
    open_.push_back({site->layer, site->path});
    follow(*site);
    open_.pop_back();
    chooseVariants(*site);
    return site;
}

/// As if the layer were a stage: with what arcs of the prims above bring, and without this prim's variants,
/// which a stronger place may select.
std::unique_ptr<PrimSite> PrimSites::siteOf(const UsdLayer& layer, const std::string& path) {
    std::unique_ptr<PrimSite> site;
    if (const auto cut = path.rfind('/'); cut == 0) {
        site = newSite(layer, nullptr, path);
        site->layer = &layer;
        site->path = path;
        site->spec = stacks_.find(layer, path);
    } else {
        const auto above = siteOf(layer, path.substr(0, cut));
        chooseVariants(*above);
        site = extended(*above, path.substr(cut + 1), nullptr);
    }
    open_.push_back({&layer, path});
    follow(*site);
    open_.pop_back();
    return site;
}

std::unique_ptr<PrimSite> PrimSites::newSite(const UsdLayer& layer, const UsdSpec* spec,
                                             const std::string& path) {
    if (++ofPrim_ > mostOfPrim || ++made_ > mostSites)
        stacks_.refuse(layer, spec, path,
                       "expected arcs that lead to at most 200000 places of a prim, and 20000000 in all");
    return std::make_unique<PrimSite>();
}

const UsdSpec* PrimSites::childOf(const UsdSpec& spec, const std::string& name) {
    if (spec.children.empty()) return nullptr;
    auto& names = children_[&spec];
    if (names.empty())
        for (const UsdSpec& child : spec.children) names.emplace(child.prim.name, &child);
    const auto found = names.find(name);
    return found == names.end() ? nullptr : found->second;
}

/// The same places for a child. Places that say nothing of it are left out; the first one stays.
std::unique_ptr<PrimSite> PrimSites::extended(const PrimSite& site, const std::string& name,
                                              PrimSite* above) {
    auto made = newSite(*site.layer, site.spec, site.path);
    made->layer = site.layer;
    made->path = site.path + "/" + name;
    made->spec = site.spec ? childOf(*site.spec, name) : nullptr;
    made->arc = site.arc;
    made->depth = site.depth;
    made->from = site.from;
    made->to = site.to;
    made->others = site.others;
    made->implied = site.implied;
    made->above = above;
    for (const auto& below : site.below) {
        auto child = extended(*below, name, made.get());
        if (saysAnything(*child)) made->below.push_back(std::move(child));
    }
    return made;
}

/// The arcs that places of this level write themselves.
void PrimSites::follow(PrimSite& site) {
    std::vector<PrimSite*> before;
    for (const auto& below : site.below) before.push_back(below.get());
    for (PrimSite* below : before) {
        follow(*below);
        imply(site, *below);
    }
    followArcs(site);
}

void PrimSites::followArcs(PrimSite& site) {
    if (!site.spec) return;
    for (const auto& [key, arc] : {std::pair{"references", UsdArc::Reference},
                                   {"payload", UsdArc::Payload},
                                   {"inheritPaths", UsdArc::Inherit},
                                   {"specializes", UsdArc::Specialize}})
        for (const std::string& text : arcsOf(site.spec->prim, key)) addArc(site, arc, text);
}

/// "@FILE@", "@FILE@</Prim>" or "/Prim".
void PrimSites::addArc(PrimSite& site, UsdArc arc, const std::string& text) {
    const UsdLayer& from = *site.layer;
    const UsdLayer* layer = &from;
    std::string target = text;
    if (text.starts_with('@')) {
        const auto end = text.rfind('@');
        const auto file = stacks_.nameOf(from, site.spec, site.path, text.substr(1, end - 1));
        if (!file) return;
        layer = &stacks_.stackOf(*file);
        stacks_.remarkUnits(*layer);
        target = end + 1 < text.size() ? text.substr(end + 2, text.size() - end - 3) : "";
    }
    if (target.empty()) {
        if (const auto* name = member<std::string>(layer->metadata, "defaultPrim"))
            target = name->starts_with('/') ? *name : "/" + *name;
    }
    if (target.empty())
        return stacks_.leaveOut(from, site.spec, site.path,
                                text + ": expected a path too, as " + layer->file + " has no defaultPrim");
    if (std::ranges::any_of(site.below, [&](const auto& one) {
            return one->layer == layer && one->path == target && one->depth == depthOf(site.path);
        }))
        return; // as in Pcp the same place speaks once
    if (leadsBack(site, *layer, target))
        return stacks_.leaveOut(from, site.spec, site.path, text + ": leads back to itself");
    if (open_.size() >= mostArcs)
        stacks_.refuse(from, site.spec, site.path, text + ": expected at most 64 arcs in each other");
    auto made = siteOf(*layer, target);
    if (!saysAnything(*made))
        return stacks_.leaveOut(from, site.spec, site.path,
                                text + ": there is no prim " + target + " in " + layer->file);
    made->arc = arc;
    made->depth = depthOf(site.path);
    made->from = target;
    made->to = site.path;
    made->others = layer == &from; // in the same layer all paths are known
    adopt(site, std::move(made));
}

/// A place that is being looked at, or one above or below it.
bool PrimSites::leadsBack(const PrimSite& site, const UsdLayer& layer, const std::string& path) {
    const auto same = [&](const UsdLayer* other, const std::string& at) {
        return other == &layer && (isUnder(at, path) || isUnder(path, at));
    };
    for (const PrimSite* one = &site; one; one = one->above)
        if (same(one->layer, one->path)) return true;
    return std::ranges::any_of(open_,
                               [&](const auto& open) { return open.first == &layer && open.second == path; });
}

/// Puts what an arc leads to below the site, by its strength.
void PrimSites::adopt(PrimSite& site, std::unique_ptr<PrimSite> below) {
    PrimSite& added = *below;
    added.above = &site;
    const auto weaker = std::ranges::find_if(site.below, [&](const auto& one) {
        return std::tuple(one->arc, added.depth, one->implied) >
               std::tuple(added.arc, one->depth, added.implied);
    });
    site.below.insert(weaker, std::move(below));
    imply(site, added);
}

/// What a weaker place inherits or specializes, of the same name in the stronger one; and what it specializes
/// is weaker than all that the stronger one has.
void PrimSites::imply(PrimSite& site, PrimSite& below) {
    if (isClassArc(below.arc)) return;
    for (const auto& [inBelow, arc] : classesOf(below)) {
        const std::string path = nameAbove(below, inBelow);
        if (below.arc == UsdArc::Variant || speaksAlready(site, path) || leadsBack(site, *site.layer, path))
            continue;
        auto implied = siteOf(*site.layer, path);
        if (!saysAnything(*implied)) continue;
        implied->arc = arc;
        implied->implied = true;
        implied->depth = depthOf(site.path);
        implied->from = path;
        implied->to = site.path;
        adopt(site, std::move(implied));
    }
    std::vector<std::unique_ptr<PrimSite>> moved;
    for (auto& one : below.below)
        if (one->arc == UsdArc::Specialize) moved.push_back(std::move(one));
    std::erase(below.below, nullptr);
    for (auto& one : moved) {
        one->to = inAbove(below, one->to).value_or(site.path);
        one->others = one->others && below.others;
        adopt(site, std::move(one));
    }
}

/// Selections count wherever they are written of the prim, so they come when all other places are known.
void PrimSites::chooseVariants(PrimSite& root) {
    while (chooseOne(root, root)) {
    }
}

bool PrimSites::chooseOne(PrimSite& root, PrimSite& site) {
    if (site.spec)
        for (const UsdVariantSet& set : site.spec->variantSets) {
            if (!site.chosen.insert(set.name).second) continue;
            const std::string* name = selected(root, set.name);
            if (!name || name->empty()) {
                stacks_.note("the variant set " + set.name + " of " +
                             inStage(site, site.path).value_or(site.path) +
                             " has no selection: none of its variants is read");
                return true;
            }
            const auto variant = std::ranges::find_if(
                set.variants, [&](const UsdSpec& one) { return one.prim.name == *name; });
            if (variant == set.variants.end()) {
                stacks_.leaveOut(*site.layer, site.spec, site.path,
                                 "the variant set " + set.name + " has no variant \"" + *name +
                                     "\", which is selected");
                return true;
            }
            auto made = std::make_unique<PrimSite>();
            made->layer = site.layer;
            made->path = made->from = made->to = site.path;
            made->spec = &*variant;
            made->arc = UsdArc::Variant;
            made->depth = depthOf(site.path);
            made->above = &site;
            PrimSite& added = *made;
            adopt(site, std::move(made));
            followArcs(added);
            imply(site, added);
            return true;
        }
    for (const auto& below : site.below)
        if (chooseOne(root, *below)) return true;
    return false;
}

} // namespace tss
