#include "bake/usd/Stage.h"

#include "bake/base/AtomicFile.h"
#include "bake/usd/MergePrims.h"
#include "bake/usd/OurLayer.h"
#include "bake/usd/ReadUsda.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>

namespace tss {

namespace {

constexpr std::size_t mostPrims = 65536, mostNumbers = 16777216, mostArcs = 64, mostFiles = 256;

Prim takePrim(UsdSpec& spec) {
    Prim prim = std::move(spec.prim);
    for (UsdSpec& child : spec.children) prim.children.push_back(takePrim(child));
    return prim;
}

class Composition {
public:
    Composition(const std::string& text, const std::string& file, const OpenUsd& open)
        : file_(file), open_(open) {
        files_[""] = std::make_unique<UsdLayer>(parseUsda(text, file, "", budget_));
    }

    UsdStage compose() {
        UsdStage stage;
        UsdLayer& first = *files_[""];
        stage.layer.metadata = first.metadata;
        const bool asItIs = first.subLayers.empty() && std::ranges::none_of(first.children, needsComposition);
        if (asItIs) {
            for (UsdSpec& child : first.children) stage.layer.children.push_back(takePrim(child));
        } else {
            UsdLayer& stack = stackOf("", {});
            for (const UsdSpec& spec : stack.children)
                stage.layer.children.push_back(expand(stack, spec, "/" + spec.prim.name, {}));
            for (Prim& prim : stage.layer.children) dropArcs(prim);
        }
        for (const auto& [name, layer] : files_)
            for (const std::string& note : layer->notes) notes_.push_back(note);
        stage.notes = std::move(notes_);
        return stage;
    }

private:
    [[noreturn]] void refuse(const UsdLayer& layer, const UsdSpec* spec, const std::string& path,
                             const std::string& message) const {
        throw InputError(Where{layer.file, spec ? "line " + std::to_string(spec->line) : "", path}, message);
    }

    /// What cannot be followed is not in the stage, as in USD, and said.
    void leaveOut(const UsdLayer& layer, const UsdSpec* spec, const std::string& path,
                  const std::string& message) {
        const Where where{layer.file, spec ? "line " + std::to_string(spec->line) : "", path};
        std::string note = std::string("left out: ") + InputError(where, message).what();
        if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(std::move(note));
    }

    /// The layer of this file with its sublayers in it.
    UsdLayer& stackOf(const std::string& name, std::vector<std::string> within) {
        if (std::ranges::find(within, name) != within.end())
            throw InputError(Where{files_[name]->file}, "subLayers: leads back to itself");
        UsdLayer& layer = layerOf(name);
        within.push_back(name);
        const std::vector<std::string> below = std::exchange(layer.subLayers, {});
        for (const std::string& arc : below) {
            if (within.size() > mostArcs)
                refuse(layer, nullptr, "", "expected at most 64 sublayers in each other");
            const auto file = nameOf(layer, nullptr, "", arc.substr(1, arc.size() - 2));
            if (!file) continue;
            UsdLayer copy = stackOf(*file, within);
            for (const UsdSpec& spec : copy.children) spend(copy, costOf(spec));
            remarkUnits(copy);
            mergeSpecs(layer.children, std::move(copy.children));
        }
        return layer;
    }

    /// The canonical name under which the layer of a file is kept; none of a file that holds no text of USD.
    std::optional<std::string> nameOf(const UsdLayer& from, const UsdSpec* spec, const std::string& path,
                                      const std::string& asset) {
        if (const auto known = names_.find(asset); known != names_.end()) return known->second;
        UsdFile opened;
        try {
            opened = open_(asset);
        } catch (const InputError& error) {
            refuse(from, spec, path, "@" + asset + "@: " + error.message);
        }
        if (opened.missing.empty()) opened.missing = notUsda(opened.text, opened.file);
        if (!opened.missing.empty()) {
            leaveOut(from, spec, path, "@" + asset + "@: " + opened.missing);
            return std::nullopt;
        }
        if (opened.file == canonical_) opened.file.clear();
        if (!files_.contains(opened.file)) {
            if (files_.size() >= mostFiles) refuse(from, spec, path, "expected at most 256 files in all");
            const std::string folder = std::filesystem::path(asset).parent_path().generic_string();
            files_[opened.file] = std::make_unique<UsdLayer>(parseUsda(opened.text, asset, folder, budget_));
        }
        return names_[asset] = opened.file;
    }

    UsdLayer& layerOf(const std::string& name) { return *files_.at(name); }

    void remarkUnits(const UsdLayer& layer) {
        const Value::Object& first = files_[""]->metadata;
        for (const char* key : {"metersPerUnit", "upAxis"}) {
            const auto own = first.find(key), theirs = layer.metadata.find(key);
            if (theirs == layer.metadata.end() || (own != first.end() && own->second == theirs->second))
                continue;
            std::string note = layer.file + " has " + key + " " + describe(theirs->second) +
                               ", unlike the first layer; as in USD, nothing is converted";
            if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(std::move(note));
        }
    }

    void spend(const UsdLayer& layer, std::size_t bytes) {
        if (bytes > budget_.memory)
            refuse(layer, nullptr, "",
                   "expected less: what the files make of each other would take too much memory");
        budget_.memory -= bytes;
    }

    void count(const UsdLayer& layer, const UsdSpec& spec, const std::string& path) {
        ++prims_;
        spend(layer, costOf(spec.prim));
        for (const auto& [name, property] : spec.prim.properties) numbers_ += numbersIn(property);
        if (prims_ > mostPrims || numbers_ > mostNumbers)
            refuse(layer, &spec, path, "expected a stage of at most 65536 prims and 16777216 numbers");
    }

    using Stronger = std::vector<const Prim*>; ///< what is said of the same prim already, the strongest first

    /// What one layer stack says of a prim and all below it, with its arcs.
    Prim expand(const UsdLayer& layer, const UsdSpec& spec, const std::string& path,
                const Stronger& stronger) {
        count(layer, spec, path);
        Prim prim = spec.prim;
        prim.children.clear();
        expandChildren(layer, spec, path, stronger, prim);
        Stronger context = stronger;
        context.push_back(&prim);
        const auto add = [&](const char* key) {
            for (const std::string& arc : arcsOf(spec.prim, key))
                addArc(layer, spec, path, arc, context, prim);
        };
        add("inheritPaths");
        for (const UsdVariantSet& set : spec.variantSets) addVariant(layer, spec, set, path, context, prim);
        const bool instance = isInstanceable(spec.prim);
        if (instance) prim.children.clear(); // what stands below an instance does not count
        add("references");
        add("payload");
        add("specializes");
        return prim;
    }

    bool isInstanceable(const Prim& prim) const {
        const auto flag = prim.metadata.find("instanceable");
        const bool arcs = prim.metadata.contains("references") || prim.metadata.contains("payload");
        return arcs && flag != prim.metadata.end() && flag->second == Value(true);
    }

    void expandChildren(const UsdLayer& layer, const UsdSpec& spec, const std::string& path,
                        const Stronger& stronger, Prim& prim) {
        std::unordered_map<std::string_view, Stronger> said;
        for (const Prim* one : stronger)
            for (const Prim& child : one->children) said[child.name].push_back(&child);
        prim.children.reserve(spec.children.size());
        for (const UsdSpec& child : spec.children)
            prim.children.push_back(
                expand(layer, child, path + "/" + child.prim.name, said[child.prim.name]));
    }

    void addVariant(const UsdLayer& layer, const UsdSpec& spec, const UsdVariantSet& set,
                    const std::string& path, const Stronger& context, Prim& prim) {
        const std::string* selected = nullptr;
        for (const Prim* one : context) {
            const auto all = one->metadata.find("variantSelection");
            const auto* object = all == one->metadata.end() ? nullptr : all->second.as<Value::Object>();
            const auto found = object ? object->find(set.name) : Value::Object::const_iterator();
            if (object && found != object->end() && !selected) selected = found->second.as<std::string>();
        }
        if (!selected || selected->empty()) {
            notes_.push_back("the variant set " + set.name + " of " + path +
                             " has no selection: none of its variants is read");
            return;
        }
        const std::string name = *selected; // the prim's own metadata change below
        for (const UsdSpec& variant : set.variants)
            if (variant.prim.name == name) {
                arcs_.push_back({&variant, path});
                Prim weaker = expand(layer, variant, path, context);
                arcs_.pop_back();
                return mergeUnder(prim, std::move(weaker));
            }
        leaveOut(layer, &spec, path,
                 "the variant set " + set.name + " has no variant \"" + name + "\", which is selected");
    }

    /// "@FILE@", "@FILE@</Prim>" or "/Prim" below what the prim says already.
    void addArc(const UsdLayer& from, const UsdSpec& spec, const std::string& path, const std::string& arc,
                const Stronger& context, Prim& prim) {
        const UsdLayer* layer = &from;
        std::string target = arc;
        if (arc.starts_with('@')) {
            const auto end = arc.find('@', 1);
            const auto file = nameOf(from, &spec, path, arc.substr(1, end - 1));
            if (!file) return;
            layer = &stackOf(*file, {});
            remarkUnits(*layer);
            target = end + 1 < arc.size() ? arc.substr(end + 2, arc.size() - end - 3) : "";
        }
        if (target.empty()) target = defaultPrim(*layer);
        if (target.empty())
            return leaveOut(from, &spec, path,
                            arc + ": expected a path too, as " + layer->file + " has no defaultPrim");
        // What only the arcs of a prim above make of it is looked for in that one, composed.
        std::string above = target;
        const UsdSpec* base = find(*layer, above);
        while (!base && above.rfind('/') != 0 && above.rfind('/') != above.npos) {
            above.resize(above.rfind('/'));
            base = find(*layer, above);
        }
        const auto missing = [&] {
            leaveOut(from, &spec, path, arc + ": there is no prim " + target + " in " + layer->file);
        };
        if (!base) return missing();
        if (leadsBack(from, spec, path, arc, *layer, base))
            return leaveOut(from, &spec, path, arc + ": leads back to itself");
        arcs_.push_back({base, above});
        Prim weaker = expand(*layer, *base, above, above == target ? context : Stronger());
        arcs_.pop_back();
        if (above != target) {
            Prim below;
            if (!takeBelow(weaker, target.substr(above.size()), below)) return missing();
            weaker = std::move(below);
        }
        movePaths(weaker, target, path);
        if (weaker.specifier == "class") weaker.specifier = "over"; // what inherits it is none
        mergeUnder(prim, std::move(weaker));
    }

    /// An arc to `base` leads back to what it is followed from, or to what is above its prim.
    bool leadsBack(const UsdLayer& from, const UsdSpec& spec, const std::string& path, const std::string& arc,
                   const UsdLayer& layer, const UsdSpec* base) {
        bool back = std::ranges::any_of(arcs_, [&](const auto& open) { return open.first == base; });
        for (std::string above = path; &layer == &from && !above.empty(); above.resize(above.rfind('/')))
            back = back || find(from, above) == base;
        if (!back && arcs_.size() >= mostArcs)
            refuse(from, &spec, path, arc + ": expected at most 64 arcs in each other");
        return back;
    }

    /// The prim at a path such as /A/B below another one, taken out of it.
    static bool takeBelow(Prim& prim, const std::string& path, Prim& below) {
        Prim* at = &prim;
        for (std::size_t begin = 1; begin <= path.size();) {
            const std::size_t end = std::min(path.find('/', begin), path.size());
            const std::string name = path.substr(begin, end - begin);
            const auto found =
                std::ranges::find_if(at->children, [&](const Prim& child) { return child.name == name; });
            if (found == at->children.end()) return false;
            at = &*found;
            begin = end + 1;
        }
        below = std::move(*at);
        return true;
    }

    /// The path of a layer's default prim; empty where it has none.
    static std::string defaultPrim(const UsdLayer& layer) {
        const auto found = layer.metadata.find("defaultPrim");
        const auto* name = found == layer.metadata.end() ? nullptr : found->second.as<std::string>();
        return !name ? "" : name->starts_with('/') ? *name : "/" + *name;
    }

    /// A layer's prims do not change once its sublayers are in it.
    const UsdSpec* find(const UsdLayer& layer, const std::string& path) {
        auto& index = indices_[&layer];
        if (index.empty()) addBelow(layer.children, "", index);
        const auto found = index.find(path);
        return found == index.end() ? nullptr : found->second;
    }

    using Index = std::unordered_map<std::string, const UsdSpec*>;

    static void addBelow(const std::vector<UsdSpec>& specs, const std::string& parent, Index& index) {
        for (const UsdSpec& spec : specs) {
            const std::string path = parent + "/" + spec.prim.name;
            index[path] = &spec;
            addBelow(spec.children, path, index);
        }
    }

    static void dropArcs(Prim& prim) {
        for (const char* key : {"references", "payload", "inheritPaths", "specializes", "variantSelection",
                                "variantSets", "instanceable"})
            prim.metadata.erase(key);
        for (Prim& child : prim.children) dropArcs(child);
    }

    std::string file_;
    const OpenUsd& open_;
    UsdBudget budget_;
    std::map<std::string, std::unique_ptr<UsdLayer>> files_; ///< the first one under ""
    std::map<std::string, std::string> names_;               ///< of files, as they are called in layers
    std::string canonical_ = std::filesystem::weakly_canonical(file_).string();
    std::vector<std::pair<const UsdSpec*, std::string>> arcs_; ///< that are being followed
    std::vector<std::string> notes_;
    std::map<const UsdLayer*, Index> indices_;
    std::size_t prims_ = 0, numbers_ = 0;
};

} // namespace

OpenUsd besideUsd(const std::string& file, const std::vector<std::string>& others) {
    namespace fs = std::filesystem;
    std::vector<fs::path> folders{fs::weakly_canonical(fs::absolute(file).parent_path())};
    for (const std::string& folder : others) folders.push_back(fs::weakly_canonical(fs::absolute(folder)));
    return [folders](const std::string& name) {
        const fs::path& folder = folders.front();
        if (name.empty() || name.find("://") != name.npos || name.find('[') != name.npos)
            throw InputError("expected a file beside the layer, and no other place");
        std::error_code error;
        const fs::path real = fs::weakly_canonical(folder / name, error);
        if (error || std::ranges::none_of(folders, [&](const fs::path& one) { return isWithin(real, one); }))
            throw InputError(
                "lies outside of " + folder.string() +
                ", the folder of the first layer; expected it there or in the folder of a --package "
                "NAME=DIR");
        if (!fs::exists(real, error)) return UsdFile{"", "", "no such file, " + real.string()};
        if (!fs::is_regular_file(real, error)) return UsdFile{"", "", "is no regular file, " + real.string()};
        if (fs::file_size(real, error) > UsdBudget().text)
            throw InputError("expected files of at most 128 MiB in all");
        return UsdFile{real.string(), readWholeFile(real.string()), ""};
    };
}

UsdStage readStage(const std::string& text, const std::string& file, const OpenUsd& open) {
    UsdStage stage = Composition(text, file, open).compose();
    stage.ours = restoreOurs(stage.layer, file);
    return stage;
}

} // namespace tss
