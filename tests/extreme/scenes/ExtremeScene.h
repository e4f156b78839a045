#pragma once
#include "bake/model/SceneModel.h"

#include <string>
#include <string_view>
#include <vector>

/// The stiff and extreme cases (METHOD 9), made by code: what stands under scenes/extreme.
namespace extreme {

/// What must become of a scene.
enum class Fate {
    Table,       ///< baked, proven, played
    NeverMeet,   ///< baked into a proof that its bodies never meet
    Skin,        ///< a skin: baked and played
    NotReadable, ///< refused when it is read
    NotBakeable, ///< read, and refused when it is baked
};

struct ExtremeScene {
    std::string name;  ///< of the file, without .tss
    std::string asked; ///< which case of METHOD 9 it is
    std::string holds; ///< what must hold, for people
    Fate fate = Fate::Table;
    std::string refusal; ///< of a refused scene: a part of its message
    std::string text;    ///< the file
};

/// All of them, in the order of METHOD 9.
const std::vector<ExtremeScene>& extremeScenes();

/// The one of that name; throws std::logic_error where there is none.
const ExtremeScene& extremeScene(std::string_view name);

/// The scene of a file's text. Throws InputError as loadScene() does; the file's name is <name>.tss.
tss::SceneModel readText(const std::string& text, const std::string& name);

} // namespace extreme
