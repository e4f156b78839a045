#pragma once
#include "bake/usd/ReadUsda.h"
#include "bake/usd/Stage.h"

#include <map>
#include <memory>
#include <unordered_map>

namespace tss {

/// The files of a stage, each read once, and what was left out of them.
class LayerStacks {
public:
    /// Throws InputError as parseUsda().
    LayerStacks(const std::string& text, const std::string& file, const OpenUsd& open);

    UsdLayer& first() { return *files_.at(""); }

    /// A layer with its sublayers in it. Throws InputError for sublayers that lead back to themselves.
    UsdLayer& stackOf(const std::string& name) { return stackOf(name, {}); }

    /// The canonical name under which the layer of a file is kept; none, noted, of a file that is not there
    /// or holds no text of USD. spec: of the prim that names it, at `path`; null: sublayers do.
    std::optional<std::string> nameOf(const UsdLayer& from, const UsdSpec* spec, const std::string& path,
                                      const std::string& asset);

    /// Units or another up axis than the first layer has are remarked upon.
    void remarkUnits(const UsdLayer& layer);

    /// What a layer, its sublayers in it, says at a path; null: nothing.
    const UsdSpec* find(const UsdLayer& layer, const std::string& path);

    /// What cannot be followed is not in the stage, as in USD, and said.
    void leaveOut(const UsdLayer& layer, const UsdSpec* spec, const std::string& path,
                  const std::string& message);
    void note(std::string note);

    [[noreturn]] void refuse(const UsdLayer& layer, const UsdSpec* spec, const std::string& path,
                             const std::string& message) const;

    /// Throws InputError where so many bytes more are too many.
    void spend(const UsdLayer& layer, std::size_t bytes);

    /// All notes, those of the files behind the others.
    std::vector<std::string> takeNotes();

private:
    UsdLayer& stackOf(const std::string& name, std::vector<std::string> within);

    using Index = std::unordered_map<std::string, const UsdSpec*>;

    const OpenUsd& open_;
    UsdBudget budget_;
    std::map<std::string, std::unique_ptr<UsdLayer>> files_; ///< the first one under ""
    std::map<std::string, std::string> names_;               ///< of files, as they are called in layers
    std::string canonical_;
    std::vector<std::string> notes_;
    std::map<const UsdLayer*, Index> indices_;
};

} // namespace tss
