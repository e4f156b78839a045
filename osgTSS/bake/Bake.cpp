#include "bake/pipeline/Bake.h"

#include "osgTSS/src/EachNode.h"

#include "bake/base/Error.h"
#include "bake/check/EarlyContact.h"
#include "bake/model/Kinematics.h"
#include "bake/model/SourceHash.h"
#include "bake/motion/WholeTurn.h"
#include "bake/pipeline/FirstLook.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "bake/table/Query.h"

#include <osg/Notify>
#include <osg/ValueObject>
#include <osgAnimation/Bone>
#include <osgSim/DOFTransform>
#include <osgTSS/Bake>
#include <osgTSS/ConstraintVisitor>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace osgTSS {

namespace {

/// Writes what options say of nodes onto them.
void tagNodes(osg::Node& root, const BakeOptions& options) {
    std::set<std::string> used; // names that there are
    const auto tag = [&](osg::Node& node, const std::vector<std::string>& names, const char* value) {
        if (std::ranges::find(names, node.getName()) == names.end()) return;
        node.setUserValue(value, true);
        used.insert(node.getName());
    };
    eachNode(root, [&](osg::Node& node) {
        tag(node, options.ignored, "osgTSS:ignored");
        if (!node.asTransform()) return;
        std::string words =
            options.writtenLimits && dynamic_cast<osgSim::DOFTransform*>(&node) ? "written" : "";
        for (const auto& [name, word] : options.limits)
            if (name == node.getName() || name == "*") {
                words += (words.empty() ? "" : " ") + word;
                used.insert(name);
            }
        if (!words.empty()) node.setUserValue("osgTSS:limits", words);
        tag(node, options.still, "osgTSS:static");
        if (options.boneStill > 0 && dynamic_cast<osgAnimation::Bone*>(&node))
            node.setUserValue("osgTSS:still", options.boneStill);
    });
    std::set<std::string> names(options.still.begin(), options.still.end());
    for (const auto& [name, word] : options.limits) names.insert(name);
    for (const std::string& name : options.ignored)
        if (!used.contains(name))
            OSG_WARN << "osgTSS: option ignore: no node is named \"" << name << "\"" << std::endl;
    for (const std::string& name : names)
        if (!used.contains(name))
            OSG_WARN << "osgTSS: options limits and static: no transform is named \"" << name << "\""
                     << std::endl;
}

ConstraintVisitor::Pairs pairsOf(const BakeOptions& options) {
    if (options.pairs == "siblings") return ConstraintVisitor::SIBLINGS;
    if (options.pairs == "all") return ConstraintVisitor::ALL;
    if (options.pairs == "tagged") return ConstraintVisitor::TAGGED;
    return ConstraintVisitor::NEIGHBOURS;
}

/// Numbers rounded to what a file stores, so that tables fit the file that the graph is saved as.
std::shared_ptr<tss::SceneModel> extract(osg::Node& root, const BakeOptions& options) {
    ConstraintVisitor visitor(pairsOf(options));
    visitor.setActiveOnly(options.activeOnly);
    root.accept(visitor);
    const tss::SceneModel& found = visitor.getModel();
    auto model = std::make_shared<tss::SceneModel>(tss::readScene(tss::toLayer(found), "the graph"));
    if (found.joints.empty() && found.skins.empty()) {
        OSG_NOTICE << "osgTSS: the graph has no joints; nothing was baked" << std::endl;
    } else if (found.pairs.empty() && found.skins.empty()) {
        OSG_NOTICE
            << "osgTSS: the graph has joints, but no pairs of bodies between them"
            << (options.pairs == "tagged"
                    ? ": pairs=tagged takes nodes with the user value \"osgTSS:collides\", and none has it"
                    : "")
            << "; nothing was baked" << std::endl;
    }
    return model;
}

bool isBaked(const tss::Pair& pair) {
    return pair.table || pair.proof;
}
bool isBaked(const tss::SkinModel& skin) {
    return bool(skin.table);
}

/// Tables and proofs of an earlier bake that still fit, whatever their pairs are called: joints without names
/// are numbered, and a file may have them in another order since. Returns how many.
std::size_t takeFromCache(tss::SceneModel& model, const std::string& file) {
    std::error_code failed;
    if (file.empty() || !std::filesystem::exists(file, failed)) return 0;
    std::size_t taken = 0;
    const auto take = [&](auto& all, const auto& cached) {
        std::map<std::string, std::size_t> madeOf;
        for (std::size_t k = 0; k < cached.size(); ++k)
            if (isBaked(cached[k])) madeOf.emplace(cached[k].sourceHash, k);
        for (auto& item : all) {
            const auto made = madeOf.find(tss::sourceHash(model, item));
            if (made == madeOf.end()) continue;
            const auto& old = cached[made->second];
            item.table = old.table;
            if constexpr (requires { item.proof; }) item.proof = old.proof;
            item.sourceHash = old.sourceHash;
            ++taken;
        }
    };
    try {
        const tss::SceneModel cached = tss::loadScene(file);
        take(model.pairs, cached.pairs);
        take(model.skins, cached.skins);
    } catch (const std::exception& error) {
        OSG_WARN << "osgTSS: " << file << " is baked anew: " << error.what() << std::endl;
    }
    return taken;
}

void keep(const tss::SceneModel& model, const std::string& cache) {
    if (cache.empty()) return;
    try {
        tss::saveScene(model, cache);
    } catch (const std::exception& error) {
        OSG_NOTICE << "osgTSS: the tables are not kept for the next time: " << error.what() << std::endl;
    }
}

/// What a person should know before trusting the joint to its table: what `tss info` warns of.
void warnOf(const tss::SceneModel& model, const tss::Pair& pair) {
    const auto early = tss::measureEarlyContact(model, pair);
    if (!early) return;
    std::ostringstream text;
    if (early->stuck())
        text << "the meshes touch or overlap wherever the joint goes";
    else if (early->held)
        text << "it is held at rest: every small step from there is contact";
    else if (early->restReported)
        text << "its tolerance is too coarse: contact is reported at rest, where the meshes are "
             << early->atRest << " apart";
    else if (early->coarse())
        text << "its tolerance is too coarse: contact is reported at " << int(100 * early->share)
             << " % of the poses where nothing touches";
    else if (early->touching())
        text << "the meshes touch at " << early->poses - early->freePoses << " of " << early->poses
             << " poses";
    else
        return;
    if (early->tolerance > 0) text << "; tolerance=" << early->tolerance << " would serve";
    OSG_WARN << "osgTSS: " << pair.path << ": " << text.str() << std::endl;
}

/// A table whose budget ended early, or whose tolerance is coarse, may say contact where the joint rests,
/// though nothing touches there: it would push the joint from where the graph has it. It stays in the cache.
void dropThoseThatPush(tss::SceneModel& model) {
    for (tss::Pair& pair : model.pairs) {
        if (!pair.table || pair.table->testCount() == 0) continue;
        double size = 0;
        for (const tss::Sphere& sphere : pair.table->a) size = std::max(size, sphere.radius);
        // What overlaps at rest counts from there, and is at 0 but for rounding.
        if (tss::query(*pair.table, tss::restValues(pair.table->motion)).gap >= -1e-6 * size) continue;
        pair.table = nullptr;
        pair.sourceHash.clear();
        OSG_WARN << "osgTSS: " << pair.path
                 << " is not kept apart: its table says contact where the joint rests; it takes a finer "
                    "tolerance, or a larger budget"
                 << std::endl;
    }
}

/// Scenes hold floats: far from the root's origin, as in geocentric coordinates, bodies that hang in the
/// root's own frame are rounded by more than their tables may be off.
void refuseTooFarOff(const tss::SceneModel& model, const tss::Pair& pair) {
    double farthest = 0, smaller = std::numeric_limits<double>::infinity();
    for (const int index : {pair.bodyA, pair.bodyB}) {
        const tss::TriangleMesh& mesh = model.bodies[index].mesh;
        if (mesh.empty()) return; // refused for that
        const auto box = tss::bounds(mesh);
        farthest = std::max({farthest, box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()});
        smaller = std::min(smaller, box.diagonal().norm());
    }
    for (const int joint : pair.joints)
        for (const tss::Pose& frame : {model.joints[joint].frame0, model.joints[joint].frame1})
            farthest = std::max(farthest, frame.translation().cwiseAbs().maxCoeff());
    const double tolerance =
        tss::optionsFor(pair.settings, {}, model.metersPerUnit).tolerance.value_or(smaller / 500);
    const double rounding = 0x1p-23 * farthest;
    if (!(rounding > 0.25 * tolerance)) return;
    std::ostringstream text;
    text << "coordinates of up to " << farthest << " from the root are rounded by " << rounding
         << " in a scene, too much for a tolerance of " << tolerance
         << "; bake and install below the transform that carries the machine there";
    throw tss::InputError(text.str());
}

/// What the bake says names options as the command has them: here they are words of -O.
std::string inWords(const std::string& text) {
    static const std::regex again("--again "), withValue("--([a-z-]+) ([0-9][0-9.e-]*|medial)"),
        alone("--([a-z-]+)");
    return std::regex_replace(std::regex_replace(std::regex_replace(text, again, ""), withValue, "$1=$2"),
                              alone, "$1");
}

/// Somebody waits for the picture: a tenth of what `tss bake` does at most. Where that ends the search for
/// few tests, all that may touch are asked, with the same answers; where it ends the patches, the spheres are
/// coarser, or the pair is not kept apart, and it is said.
constexpr double effort = 0.1;

/// Over how many joint values a pair turns all the way round.
std::ptrdiff_t wholeTurns(const tss::SceneModel& model, const tss::Pair& pair) {
    return std::ranges::count_if(pairDofs(model, pair), [&](const tss::JointDof& dof) {
        return tss::wholeTurn(model.joints[dof.joint].dofs[dof.dof]);
    });
}

/// settings: those asked for.
void setFirstLook(tss::SceneModel& model, const std::map<std::string, std::string>& settings) {
    std::ostringstream tolerance, budget;
    tolerance << tss::usualTolerance(model);
    budget << tss::firstBudget(model);
    const bool asked = settings.contains("tolerance");
    std::size_t coarse = 0;
    for (tss::Pair& pair : model.pairs) {
        if (!tss::isLongChain(model, pair) && wholeTurns(model, pair) < 2) continue;
        if (!asked) pair.settings["tolerance"] = tolerance.str();
        if (!settings.contains("budget")) pair.settings["budget"] = budget.str();
        ++coarse;
    }
    if (coarse > 0 && !asked)
        OSG_NOTICE << "osgTSS: " << coarse
                   << " pairs have more than three joint values, or turn all the way round about several "
                      "axes: tolerance="
                   << tolerance.str() << " for a first look at them; a finer one in -O takes longer"
                   << std::endl;
}

/// A pair or skin that cannot be baked is shown as it moves, and the others are kept apart all the same.
/// told: notes so far, of which many are about a body and come with each of its pairs.
void bakeOne(tss::SceneModel& model, const std::string& path, const BakeOptions& options,
             std::set<std::string>& told, const tss::Progress& progress) {
    tss::BakeRequest request;
    request.given = options.settings;
    request.pairs = {path};
    request.effort = effort;
    try {
        if (const int pair = tss::findPair(model, path); pair >= 0) refuseTooFarOff(model, model.pairs[pair]);
        for (const tss::PairReport& report : tss::bake(model, request, progress)) {
            const int pair = tss::findPair(model, path);
            std::string made = "never collides";
            if (pair >= 0 && model.pairs[pair].table)
                made = std::to_string(model.pairs[pair].table->testCount()) + " tests";
            if (const int skin = tss::findSkin(model, path); skin >= 0)
                made = std::to_string(model.skins[skin].table->table.testCount()) + " tests";
            OSG_NOTICE << "osgTSS: baked " << path << " in " << report.seconds << " s: " << made << std::endl;
            for (const std::string& note : report.notes)
                if (told.insert(note).second) OSG_NOTICE << "osgTSS:   " << inWords(note) << std::endl;
            if (pair >= 0) warnOf(model, model.pairs[pair]);
        }
    } catch (const tss::InputError& error) {
        OSG_WARN << "osgTSS: " << path << " is not kept apart: " << inWords(error.what()) << std::endl;
    }
}

} // namespace

osg::ref_ptr<Scene> bake(osg::Node& root, const BakeOptions& options, const BakeProgress& progress) {
    for (const std::string& key : options.unknown) {
        const std::string meant = nearestOption(key);
        if (meant.empty()) { // other plugins have words of their own in the same string
            OSG_NOTICE << "osgTSS: option \"" << key << "\" is none of osgTSS's" << std::endl;
        } else {
            OSG_WARN << "osgTSS: option \"" << key << "\" is not known; was " << meant << " meant?"
                     << std::endl;
        }
    }
    tss::optionsFor({}, options.settings, 1); // set in code: a wrong one is no pair's fault
    tagNodes(root, options);
    std::shared_ptr<tss::SceneModel> model = extract(root, options);
    if (options.firstLook) setFirstLook(*model, options.settings);
    for (tss::Pair& pair : model->pairs)
        for (const auto& [key, value] : options.settings) pair.settings[key] = value;
    for (tss::SkinModel& skin : model->skins)
        for (const auto& [key, value] : options.settings) skin.settings[key] = value;
    const std::string cache = options.cache == "off" ? "" : options.cache;
    std::size_t taken = takeFromCache(*model, cache), made = 0;
    const std::size_t count = model->pairs.size() + model->skins.size();
    if (taken > 0)
        OSG_NOTICE << "osgTSS: " << taken << " of " << count << " pairs and skins are as baked in " << cache
                   << std::endl;
    // Now and then, so that what a long bake has done by when it is ended is not lost.
    using Time = std::chrono::steady_clock;
    constexpr auto saveEvery = std::chrono::seconds(10);
    Time::time_point saved = Time::now();
    std::set<std::string> told;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t skin = k - std::min(k, model->pairs.size());
        const bool isPair = k < model->pairs.size();
        const std::string path = isPair ? model->pairs[k].path : model->skins[skin].path;
        const auto share = [&](double done) {
            return (static_cast<double>(k) + done) / static_cast<double>(count);
        };
        if (progress && !progress(path, share(0))) break;
        if (isPair && (model->pairs[k].table || model->pairs[k].proof)) { // from the cache
            warnOf(*model, model->pairs[k]);
            continue;
        }
        if (!isPair && model->skins[skin].table) continue;
        bakeOne(*model, path, options, told, [&](std::string_view step, double done) {
            return !progress || progress(path + ": " + std::string(step), share(done));
        });
        ++made;
        if (Time::now() - saved < saveEvery) continue;
        keep(*model, cache);
        saved = Time::now();
    }
    if (made > 0) keep(*model, cache);
    dropThoseThatPush(*model);
    return new Scene(model);
}

} // namespace osgTSS
