#pragma once
#include "bake/model/SceneModel.h"

#include <osg/Node>

#include <optional>
#include <string>
#include <vector>

// What user values say of skins, of muscles and of what lies below them.
namespace osgTSS {

inline const char* const skinTag = "osgTSS:skin";
inline const char* const muscleTag = "osgTSS:muscle";
inline const char* const boneTag = "osgTSS:bone";
inline const char* const activationTag = "osgTSS:activation";

/// The words of a user value; of a plain `true` none. Nothing where the node has no such value, or `false`.
std::optional<std::string> tagWords(const osg::Node& node, const char* tag);

/// Splits words at blanks.
std::vector<std::string> wordsOf(const std::string& text);

/// "self thickness=0.01 travel=0.1 stretch=0.5 bend=0.5": how a skin behaves; without a mesh, bones and
/// muscles. Throws tss::InputError.
tss::SkinModel parseSkin(const std::string& words);

/// A muscle as its words say: without a surface and a fibre.
struct TaggedMuscle {
    tss::MuscleModel model;
    std::vector<std::string> skins; ///< the names of those that it pushes; none: all
    std::string to; ///< the name of the bone that its insertion moves with; empty: as its origin
};

/// "sheet contract=0.15 anchor=0.5 skin=NAME to=NAME". Throws tss::InputError.
TaggedMuscle parseMuscle(const std::string& words);

/// "0:0 1:1 2:0": activations over seconds, as samples over time codes. Throws tss::InputError.
tss::TimeSamples parseActivation(const std::string& words, double timeCodesPerSecond);

} // namespace osgTSS
