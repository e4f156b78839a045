#include "bake/usd/LayerStacks.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace tss {

namespace {

constexpr std::size_t mostWithin = 64, mostFiles = 256;

void addBelow(const std::vector<UsdSpec>& specs, const std::string& parent,
              std::unordered_map<std::string, const UsdSpec*>& index) {
    for (const UsdSpec& spec : specs) {
        const std::string path = parent + "/" + spec.prim.name;
        index[path] = &spec;
        addBelow(spec.children, path, index);
    }
}

} // namespace

LayerStacks::LayerStacks(const std::string& text, const std::string& file, const OpenUsd& open)
    : open_(open), canonical_(std::filesystem::weakly_canonical(file).string()) {
    files_[""] = std::make_unique<UsdLayer>(parseUsda(text, file, "", budget_));
}

void LayerStacks::refuse(const UsdLayer& layer, const UsdSpec* spec, const std::string& path,
                         const std::string& message) const {
    throw InputError(Where{layer.file, spec ? "line " + std::to_string(spec->line) : "", path}, message);
}

void LayerStacks::leaveOut(const UsdLayer& layer, const UsdSpec* spec, const std::string& path,
                           const std::string& message) {
    const Where where{layer.file, spec ? "line " + std::to_string(spec->line) : "", path};
    note(std::string("left out: ") + InputError(where, message).what());
}

void LayerStacks::note(std::string note) {
    if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(std::move(note));
}

std::vector<std::string> LayerStacks::takeNotes() {
    for (const auto& [name, layer] : files_)
        notes_.insert(notes_.end(), layer->notes.begin(), layer->notes.end());
    return std::move(notes_);
}

UsdLayer& LayerStacks::stackOf(const std::string& name, std::vector<std::string> within) {
    if (std::ranges::find(within, name) != within.end())
        throw InputError(Where{files_[name]->file}, "subLayers: leads back to itself");
    UsdLayer& layer = *files_.at(name);
    within.push_back(name);
    const std::vector<std::string> below = std::exchange(layer.subLayers, {});
    for (const std::string& arc : below) {
        if (within.size() > mostWithin)
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

std::optional<std::string> LayerStacks::nameOf(const UsdLayer& from, const UsdSpec* spec,
                                               const std::string& path, const std::string& asset) {
    if (const auto known = names_.find(asset); known != names_.end()) return known->second;
    UsdFile opened;
    try {
        opened = open_(asset);
    } catch (const InputError& error) {
        refuse(from, spec, path, "@" + asset + "@: " + error.message);
    }
    if (opened.missing.empty()) opened.missing = notUsda(opened.text, files_[""]->file);
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

void LayerStacks::remarkUnits(const UsdLayer& layer) {
    const Value::Object& first = files_[""]->metadata;
    for (const char* key : {"metersPerUnit", "upAxis"}) {
        const auto own = first.find(key), theirs = layer.metadata.find(key);
        if (theirs == layer.metadata.end() || (own != first.end() && own->second == theirs->second)) continue;
        note(layer.file + " has " + key + " " + describe(theirs->second) +
             ", unlike the first layer; as in USD, nothing is converted");
    }
}

void LayerStacks::spend(const UsdLayer& layer, std::size_t bytes) {
    if (bytes > budget_.memory)
        refuse(layer, nullptr, "",
               "expected less: what the files make of each other would take too much memory");
    budget_.memory -= bytes;
}

/// A layer's prims do not change once its sublayers are in it.
const UsdSpec* LayerStacks::find(const UsdLayer& layer, const std::string& path) {
    auto& index = indices_[&layer];
    if (index.empty()) addBelow(layer.children, "", index);
    const auto found = index.find(path);
    return found == index.end() ? nullptr : found->second;
}

} // namespace tss
