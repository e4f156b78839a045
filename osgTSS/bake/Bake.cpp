#include "bake/pipeline/Bake.h"

#include "TableCache.h"
#include "osgTSS/src/EachNode.h"

#include "bake/base/Error.h"
#include "bake/check/EarlyContact.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/WholeTurn.h"
#include "bake/pipeline/FirstLook.h"
#include "bake/scene/SceneLayer.h"
#include "bake/table/Query.h"

#include <osg/Notify>
#include <osg/ValueObject>
#include <osgAnimation/Bone>
#include <osgSim/DOFTransform>
#include <osgTSS/Bake>
#include <osgTSS/ConstraintVisitor>

#include <algorithm>
#include <limits>
#include <regex>
#include <set>
#include <sstream>

namespace osgTSS {

namespace {

/// Warns of options that are not known; those that resemble none may be other plugins', whose words stand in
/// the same string.
void warnOfUnknown(const BakeOptions& options) {
    for (const std::string& key : options.unknown) {
        const std::string meant = nearestOption(key);
        if (meant.empty()) { // OSG's macros are an if: without braces the else would be theirs
            OSG_NOTICE << "osgTSS: option \"" << key << "\" is none of osgTSS's" << std::endl;
        } else {
            OSG_WARN << "osgTSS: option \"" << key << "\" is not known; was " << meant << " meant?"
                     << std::endl;
        }
    }
}

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

/// Warns of what a person should know before trusting the joint to its table, as `tss info` does.
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

/// A message of the bake, which names options as the command line has them, with the words of -O instead.
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

/// The number of joint values over which a pair turns all the way round.
std::ptrdiff_t wholeTurns(const tss::SceneModel& model, const tss::Pair& pair) {
    return std::ranges::count_if(pairDofs(model, pair), [&](const tss::JointDof& dof) {
        return tss::wholeTurn(model.joints[dof.joint].dofs[dof.dof]);
    });
}

/// Gives pairs with a large space of poses a coarse tolerance and a short budget, where `settings`, those
/// asked for, say nothing of these.
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

/// Bones of skeletons, which alone are pairs without a joint that ties them, are solid: cut out of one mesh,
/// they swing into each other at the ends of their limits.
void takeForSolid(tss::SceneModel& model) {
    for (tss::Pair& pair : model.pairs)
        if (!tss::tiesDirectly(model, pair)) pair.settings["inside"] = "contact";
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

/// Bakes all pairs and skins that have nothing from the cache, until progress says stop. Returns whether
/// there were any.
bool bakeMissing(tss::SceneModel& model, const BakeOptions& options, TableCache& cache,
                 const BakeProgress& progress) {
    std::vector<std::string> paths;
    for (const tss::Pair& pair : model.pairs) paths.push_back(pair.path);
    for (const tss::SkinModel& skin : model.skins) paths.push_back(skin.path);
    std::set<std::string> told;
    bool any = false;
    for (std::size_t k = 0; k < paths.size(); ++k) {
        const auto share = [&](double done) {
            return (static_cast<double>(k) + done) / static_cast<double>(paths.size());
        };
        if (progress && !progress(paths[k], share(0))) break;
        if (k < model.pairs.size()) {
            const tss::Pair& pair = model.pairs[k];
            if (pair.table || pair.proof) {
                warnOf(model, pair);
                continue;
            }
        } else if (model.skins[k - model.pairs.size()].table) {
            continue;
        }
        bakeOne(model, paths[k], options, told, [&](std::string_view step, double done) {
            return !progress || progress(paths[k] + ": " + std::string(step), share(done));
        });
        any = true;
        cache.saveNowAndThen(model);
    }
    return any;
}

} // namespace

osg::ref_ptr<Scene> bake(osg::Node& root, const BakeOptions& options, const BakeProgress& progress) {
    warnOfUnknown(options);
    tss::optionsFor({}, options.settings, 1); // set in code: a wrong one is no pair's fault
    tagNodes(root, options);
    std::shared_ptr<tss::SceneModel> model = extract(root, options);
    if (options.firstLook && options.pairs == BakeOptions().pairs) takeForSolid(*model);
    if (options.firstLook) setFirstLook(*model, options.settings);
    for (tss::Pair& pair : model->pairs)
        for (const auto& [key, value] : options.settings) pair.settings[key] = value;
    for (tss::SkinModel& skin : model->skins)
        for (const auto& [key, value] : options.settings) skin.settings[key] = value;
    TableCache cache(options.cache == "off" ? "" : options.cache);
    if (const std::size_t taken = cache.takeInto(*model); taken > 0)
        OSG_NOTICE << "osgTSS: " << taken << " of " << model->pairs.size() + model->skins.size()
                   << " pairs and skins are as baked in " << options.cache << std::endl;
    if (bakeMissing(*model, options, cache, progress)) cache.save(*model);
    dropThoseThatPush(*model);
    return new Scene(model);
}

} // namespace osgTSS
