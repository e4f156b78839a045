#include "bake/robot/WritePairs.h"

#include "bake/scene/Properties.h"
#include "bake/scene/SceneFile.h"

#include <cmath>
#include <fmt/format.h>
#include <map>

namespace tss {

namespace {

/// For text and attributes of XML; a comment may hold no two dashes.
std::string escaped(const std::string& text) {
    static const std::map<char, std::string> entities = {
        {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
    std::string safe;
    for (char c : text) {
        const auto entity = entities.find(c);
        safe += entity == entities.end() ? std::string(1, c) : entity->second;
    }
    return safe;
}

std::string comment(std::string text) {
    for (auto at = text.find("--"); at != text.npos; at = text.find("--")) text.replace(at, 2, "- -");
    return "    <!-- " + escaped(text) + " -->\n";
}

/// Rounded down to four digits: what is "at least" stays true.
std::string millimetres(double length, double metersPerUnit) {
    const double mm = 1000 * length * metersPerUnit;
    const double unit = mm > 0 ? std::pow(10.0, std::floor(std::log10(mm)) - 3) : 1;
    return fmt::format("{:.4g} mm", std::floor(mm / unit) * unit);
}

/// What the evidence is, in words.
std::string reasonText(const SceneModel& scene, const PairEvidence& pair) {
    const std::string length = millimetres(pair.clearance, scene.metersPerUnit);
    switch (pair.verdict) {
    case Meeting::Never:
        return pair.baked ? "proven apart by at least " + length + " at every pose within the limits"
                          : "fixed to each other, " + length + " apart";
    case Meeting::Always:
        return "fixed to each other, and their meshes overlap";
    case Meeting::Meets:
        return "the meshes meet, as at " + pair.pose;
    case Meeting::Open:
        break;
    }
    if (pair.pose.empty()) return "not a pair of the scene";
    return std::string("no proof") + (pair.baked ? "" : " (not baked)") +
           " and no contact was found; nearest " + length + ", at " + pair.pose;
}

/// The reason of an SRDF; empty where the pair stays on.
std::string reasonOf(const PairEvidence& pair) {
    if (pair.adjacent) return "Adjacent";
    if (pair.verdict == Meeting::Never) return "Never";
    if (pair.verdict == Meeting::Always) return "Always";
    return "";
}

void count(const PairEvidence& pair, PairsWritten& written) {
    const std::string reason = reasonOf(pair);
    if (reason == "Adjacent")
        ++written.adjacent;
    else if (reason == "Never")
        ++written.never;
    else if (reason == "Always")
        ++written.always;
    else if (pair.verdict == Meeting::Meets)
        ++written.meets;
    else
        ++written.open;
}

/// Each pair with a comment; `off` writes the line that switches one off.
template <class Off>
PairsWritten writePairs(const SceneModel& scene, const std::vector<PairEvidence>& evidence, const Off& off) {
    PairsWritten written;
    for (const PairEvidence& pair : evidence) {
        const std::string a = originalName(scene.bodies[pair.bodyA]),
                          b = originalName(scene.bodies[pair.bodyB]);
        const std::string reason = reasonOf(pair);
        count(pair, written);
        written.text += comment(a + ", " + b + ": " + (reason.empty() ? "stay on: " : "") +
                                (reason == "Adjacent" ? "joined; " : "") + reasonText(scene, pair));
        if (!reason.empty()) written.text += off(pair, escaped(a), escaped(b), reason);
    }
    return written;
}

std::string heading(const std::string& source) {
    return "<?xml version=\"1.0\"?>\n<!-- Made by osgTSS from " + escaped(source) +
           ". Lengths are of the scene's meshes; angles are degrees. -->\n";
}

} // namespace

PairsWritten srdfOf(const SceneModel& scene, const std::vector<PairEvidence>& evidence,
                    const std::string& source) {
    PairsWritten written =
        writePairs(scene, evidence, [](const auto&, const auto& a, const auto& b, const auto& reason) {
            return "    <disable_collisions link1=\"" + a + "\" link2=\"" + b + "\" reason=\"" + reason +
                   "\"/>\n";
        });
    written.text = heading(source) + "<robot name=\"" +
                   escaped(scene.displayName.empty() ? scene.defaultPrim : scene.displayName) + "\">\n" +
                   written.text + "</robot>\n";
    return written;
}

PairsWritten mjcfExcludesOf(const SceneModel& scene, const std::vector<PairEvidence>& evidence,
                            const std::string& source) {
    const auto named = [&](const PairEvidence& pair) {
        return scene.bodies[pair.bodyA].named && scene.bodies[pair.bodyB].named;
    };
    PairsWritten written =
        writePairs(scene, evidence, [&](const auto& pair, const auto& a, const auto& b, const auto&) {
            if (!named(pair)) return comment("left on: MuJoCo knows no body without a name");
            return "    <exclude body1=\"" + a + "\" body2=\"" + b + "\"/>\n";
        });
    written.text = heading(source) + "<mujoco>\n  <contact>\n" + written.text + "  </contact>\n</mujoco>\n";
    return written;
}

Layer withFilteredPairs(const SceneModel& scene, const std::vector<PairEvidence>& evidence) {
    std::map<int, std::vector<std::string>> partners;
    for (const PairEvidence& pair : evidence)
        if (pair.verdict == Meeting::Never) partners[pair.bodyA].push_back(scene.bodies[pair.bodyB].path);
    Layer layer = layerOf(scene);
    for (const auto& [body, paths] : partners) {
        Prim* prim = findPrim(layer, scene.bodies[body].path);
        if (!prim) continue;
        addApi(*prim, "PhysicsFilteredPairsAPI");
        PrimWriter(*prim).setTargets({"physics:filteredPairs", "rel"}, paths);
    }
    return layer;
}

} // namespace tss
