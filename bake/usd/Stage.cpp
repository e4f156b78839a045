#include "bake/usd/Stage.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Words.h"
#include "bake/usd/MergePrims.h"
#include "bake/usd/OurLayer.h"
#include "bake/usd/PrimSites.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace tss {

namespace {

constexpr std::size_t mostPrims = 65536, mostNumbers = 16777216;

Prim takePrim(UsdSpec& spec) {
    Prim prim = std::move(spec.prim);
    for (UsdSpec& child : spec.children) prim.children.push_back(takePrim(child));
    return prim;
}

/// All places that speak of a prim, the strongest first.
void listSites(const PrimSite& site, std::vector<const PrimSite*>& list) {
    if (site.spec) list.push_back(&site);
    for (const auto& below : site.below) listSites(*below, list);
}

void listPaths(const std::vector<UsdSpec>& specs, const std::string& above, std::set<std::string>& paths) {
    for (const UsdSpec& spec : specs) {
        const std::string path = above + "/" + spec.prim.name;
        paths.insert(path);
        listPaths(spec.children, path, paths);
    }
}

/// Whether what prims reference in the same layer is written there, and not above or below themselves: then
/// the scene's own reader follows it.
bool referencesStand(const std::vector<UsdSpec>& specs, const std::string& above,
                     const std::set<std::string>& paths) {
    return std::ranges::all_of(specs, [&](const UsdSpec& spec) {
        const std::string path = above + "/" + spec.prim.name;
        for (const std::string& target : arcsOf(spec.prim, "references"))
            if (!paths.contains(target) || (path + "/").starts_with(target + "/") ||
                (target + "/").starts_with(path + "/"))
                return false;
        return referencesStand(spec.children, path, paths);
    });
}

class Composition {
public:
    Composition(const std::string& text, const std::string& file, const OpenUsd& open)
        : stacks_(text, file, open), sites_(stacks_) {}

    UsdStage compose() {
        UsdStage stage;
        UsdLayer& first = stacks_.first();
        stage.layer.metadata = first.metadata;
        std::set<std::string> paths;
        listPaths(first.children, "", paths);
        const bool asItIs = first.subLayers.empty() &&
                            std::ranges::none_of(first.children, needsComposition) &&
                            referencesStand(first.children, "", paths);
        if (asItIs) {
            for (UsdSpec& child : first.children) stage.layer.children.push_back(takePrim(child));
        } else {
            const UsdLayer& stack = stacks_.stackOf("");
            for (const UsdSpec& spec : stack.children)
                stage.layer.children.push_back(primOf(*sites_.top(stack, spec.prim.name)));
        }
        constexpr std::size_t most = 2;
        if (!outside_.empty())
            stacks_.note("targets out of what is referenced of their file, which name nothing, as in USD: " +
                         firstOf(outside_, most));
        stage.notes = stacks_.takeNotes();
        return stage;
    }

private:
    /// The prim, and all below it.
    Prim primOf(const PrimSite& site) {
        std::vector<const PrimSite*> speak;
        listSites(site, speak);
        Prim prim;
        for (const PrimSite* one : speak) {
            count(*one);
            Prim said = one->spec->prim;
            mapPaths(said, [&](const std::string& path) {
                const auto there = inStage(*one, path);
                if (!there) outside_.push_back(path + " at " + one->path + " of " + one->layer->file);
                return there;
            });
            if (isClassBased(*one) && said.specifier == "class") said.specifier = "over";
            if (one == speak.front())
                prim = std::move(said);
            else
                mergeUnder(prim, std::move(said));
        }
        prim.name = site.path.substr(site.path.rfind('/') + 1);
        if (++prims_ > mostPrims || numbers_ > mostNumbers)
            stacks_.refuse(*site.layer, site.spec, site.path,
                           "expected a stage of at most 65536 prims and 16777216 numbers");
        const auto flag = prim.metadata.find("instanceable");
        const bool brings = std::ranges::any_of(site.below, [](const auto& below) {
            return below->arc == UsdArc::Reference || below->arc == UsdArc::Payload;
        });
        const bool ownBelow = !(brings && flag != prim.metadata.end() && flag->second == Value(true));
        if (!ownBelow) std::erase(speak, &site);
        // In USD those of the weaker stand first.
        std::set<std::string> names;
        for (auto one = speak.rbegin(); one != speak.rend(); ++one)
            for (const UsdSpec& child : (*one)->spec->children)
                if (names.insert(child.prim.name).second)
                    prim.children.push_back(primOf(*sites_.child(site, child.prim.name, ownBelow)));
        for (const char* key : {"references", "payload", "inheritPaths", "specializes", "variantSelection",
                                "variantSets", "instanceable"})
            prim.metadata.erase(key);
        return prim;
    }

    /// What inherits or references a class is none.
    static bool isClassBased(const PrimSite& site) { return site.above != nullptr; }

    void count(const PrimSite& site) {
        stacks_.spend(*site.layer, costOf(site.spec->prim));
        for (const auto& [name, property] : site.spec->prim.properties) numbers_ += numbersIn(property);
    }

    LayerStacks stacks_;
    PrimSites sites_;
    std::size_t prims_ = 0, numbers_ = 0;
    std::vector<std::string> outside_; ///< targets out of what is referenced
};

} // namespace

OpenUsd besideUsd(const FindMesh& find) {
    return [find](const std::string& name) {
        if (name.find("://") != name.npos || name.find('[') != name.npos)
            return UsdFile{"", "", "is no file of its own on this disk"};
        const std::string file = find(name);
        std::error_code error;
        if (!std::filesystem::exists(file, error)) return UsdFile{"", "", "no such file, " + file};
        if (!std::filesystem::is_regular_file(file, error))
            return UsdFile{"", "", "is no regular file, " + file};
        if (std::filesystem::file_size(file, error) > UsdBudget().text)
            throw InputError("expected files of at most 128 MiB in all");
        return UsdFile{file, readWholeFile(file), ""};
    };
}

UsdStage readStage(const std::string& text, const std::string& file, const OpenUsd& open) {
    UsdStage stage = Composition(text, file, open).compose();
    stage.ours = restoreOurs(stage.layer, file);
    return stage;
}

} // namespace tss
