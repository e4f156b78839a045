#pragma once
#include "bake/usd/LayerStacks.h"

#include <memory>
#include <set>

namespace tss {

/// How a place that speaks of a prim was come to, in USD's order of strength (LIVRPS).
enum class UsdArc { Local, Inherit, Variant, Reference, Payload, Specialize };

/// A place that speaks of one prim of the stage, and the places that arcs lead to from there: what Pcp calls
/// a node of the prim's index. The strongest first is the node itself, then `below` in order.
struct PrimSite {
    const UsdLayer* layer = nullptr; ///< with its sublayers in it
    std::string path;                ///< of the prim there
    const UsdSpec* spec = nullptr;   ///< null: it says nothing of this prim itself
    UsdArc arc = UsdArc::Local;
    std::size_t depth = 0; ///< how deep in the namespace of `above` the arc was
    std::string from, to;  ///< paths under `from` are those under `to` in the site above
    bool implied = false;  ///< by what a weaker place inherits or specializes
    bool others = true;    ///< other paths are there what they are here
    PrimSite* above = nullptr;
    std::vector<std::unique_ptr<PrimSite>> below;
    std::set<std::string> chosen; ///< variant sets of the spec that a variant was looked for of
};

/// Finds what speaks of a prim as Pcp does: a prim has the arcs of all places that speak of it, and of those
/// above each. Arcs of one kind are the stronger the deeper they are written; inherits and specializes of
/// what is weaker are looked for in what is stronger too.
class PrimSites {
public:
    explicit PrimSites(LayerStacks& stacks) : stacks_(stacks) {}

    /// Of a prim of the first layer at the top.
    std::unique_ptr<PrimSite> top(const UsdLayer& layer, const std::string& name);

    /// Of a child of the prim. ownBelow: false where the prim is an instance, below which only what it
    /// references counts.
    std::unique_ptr<PrimSite> child(const PrimSite& prim, const std::string& name, bool ownBelow);

private:
    std::unique_ptr<PrimSite> siteOf(const UsdLayer& layer, const std::string& path);
    std::unique_ptr<PrimSite> extended(const PrimSite& site, const std::string& name, PrimSite* above);
    std::unique_ptr<PrimSite> newSite(const UsdLayer& layer, const UsdSpec* spec, const std::string& path);
    const UsdSpec* childOf(const UsdSpec& spec, const std::string& name);
    void follow(PrimSite& site);
    void followArcs(PrimSite& site);
    void addArc(PrimSite& site, UsdArc arc, const std::string& text);
    void chooseVariants(PrimSite& root);
    bool chooseOne(PrimSite& root, PrimSite& site);
    void adopt(PrimSite& site, std::unique_ptr<PrimSite> below);
    void imply(PrimSite& site, PrimSite& below);
    bool leadsBack(const PrimSite& site, const UsdLayer& layer, const std::string& path);

    LayerStacks& stacks_;
    std::vector<std::pair<const UsdLayer*, std::string>> open_; ///< sites that arcs are being followed from
    std::map<const UsdSpec*, std::unordered_map<std::string, const UsdSpec*>> children_;
    std::size_t ofPrim_ = 0, made_ = 0; ///< places that were looked at, for one prim and in all
};

/// A path of the site as it is in the prim's own namespace; none: it is out of what an arc brings along.
std::optional<std::string> inStage(const PrimSite& site, const std::string& path);

} // namespace tss
