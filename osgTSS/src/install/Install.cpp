#include "InstallSkins.h"
#include "bake/base/UnionFind.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/UserValues.h"
#include "osgTSS/src/extract/Machines.h"
#include "osgTSS/src/extract/MovedNodes.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osg/Notify>
#include <osg/UserDataContainer>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>
#include <osgTSS/Install>
#include <osgTSS/JointCallback>
#include <osgTSS/LimitsCallback>

#include <algorithm>
#include <map>

namespace osgTSS {

namespace {

/// Places of pairs with a table, grouped so that those that share a joint's node are together; groups and
/// places in the scene's order.
std::vector<std::vector<PairPlace>> grouped(const std::vector<PairPlace>& places) {
    tss::UnionFind together(places.size());
    std::map<const osg::Node*, std::size_t> firstOfNode;
    for (std::size_t p = 0; p < places.size(); ++p)
        for (const osg::Node* node : places[p].joints)
            together.join(firstOfNode.emplace(node, p).first->second, p);
    std::vector<std::vector<PairPlace>> groups(places.size());
    for (std::size_t p = 0; p < places.size(); ++p) groups[together.root(p)].push_back(places[p]);
    std::erase_if(groups, [](const auto& members) { return members.empty(); });
    return groups;
}

/// The lowest node that every way from the root to any of the nodes passes.
osg::Node* lowestAbove(osg::Node& root, const std::vector<osg::Node*>& nodes) {
    osg::NodePath common;
    bool first = true;
    for (osg::Node* node : nodes)
        for (const osg::NodePath& path : node->getParentalNodePaths(&root)) {
            if (first) common = path;
            first = false;
            std::erase_if(common, [&](osg::Node* n) { return std::ranges::find(path, n) == path.end(); });
        }
    if (common.empty()) return &root;
    // A rigged mesh is deformed within its skeleton, after the bones.
    const bool bones =
        std::ranges::any_of(nodes, [](osg::Node* node) { return dynamic_cast<osgAnimation::Bone*>(node); });
    const auto skeleton = std::find_if(common.rbegin(), common.rend(), [](osg::Node* node) {
        return dynamic_cast<osgAnimation::Skeleton*>(node);
    });
    return bones && skeleton != common.rend() ? *skeleton : common.back();
}

/// On a node that install() hung a scene on. What createGraph() makes has its scene from there, and keeps it.
const char* const hungTag = "osgTSS:hung";

void hang(osg::Node& root, Scene& scene) {
    const bool had = Scene::on(root);
    scene.attachTo(root);
    if (!had) root.setUserValue(hungTag, true);
}

void takeOffScene(osg::Node& node) {
    if (!hasFlag(node, hungTag)) return;
    osg::UserDataContainer* container = node.getUserDataContainer();
    if (container->referenceCount() > 1) { // shared by copies of the graph
        container = osg::clone(container, osg::CopyOp::SHALLOW_COPY);
        node.setUserDataContainer(container);
    }
    for (unsigned int i = container->getNumUserObjects(); i-- > 0;) {
        const osg::Object* object = container->getUserObject(i);
        if (object->getName() == hungTag || dynamic_cast<const Scene*>(object))
            container->removeUserObject(i);
    }
}

void removeCallbacks(osg::Node& node) {
    osg::ref_ptr<osg::Callback> callback = node.getUpdateCallback();
    while (callback) {
        osg::ref_ptr<osg::Callback> next = callback->getNestedCallback();
        // A muscle on its own drawable plays without any table.
        const bool ours = isInstalled(*callback) && !node.asDrawable();
        if (ours && node.getUpdateCallback() == callback)
            node.setUpdateCallback(next); // copies of the graph go on sharing what was there
        else if (ours)
            node.removeUpdateCallback(callback);
        callback = next;
    }
}

void installGroup(osg::Node& root, Scene& scene, const std::vector<PairPlace>& group, Installed& installed) {
    const tss::SceneModel& model = scene.getModel();
    std::vector<osg::Node*> joints;
    std::vector<std::string> paths;
    for (const PairPlace& place : group) {
        const std::string& path = model.pairs[place.pair].path;
        if (std::ranges::find(paths, path) != paths.end()) {
            OSG_WARN << "osgTSS: pair " << path
                     << ": several machines of one name share joints; one is served" << std::endl;
            continue;
        }
        joints.insert(joints.end(), place.joints.begin(), place.joints.end());
        paths.push_back(path);
    }
    installed.joints += static_cast<unsigned int>(paths.size());
    osg::Node& node = *lowestAbove(root, joints);
    // The callback looks for its joints by name, below where it stands.
    const auto below = findJointNodes(node);
    for (const PairPlace& place : group)
        for (std::size_t k = 0; k < place.joints.size(); ++k) {
            const std::string& path = model.joints[model.pairs[place.pair].joints[k]].path;
            if (below.at(path).front() != place.joints[k])
                OSG_WARN << "osgTSS: joint " << path << " is there several times below node \""
                         << node.getName() << "\", and is served once; give each machine a node of its own"
                         << std::endl;
        }
    osg::ref_ptr<JointCallback> callback = new JointCallback(&scene, paths);
    addOutermost(node, *callback);
    callback->start(node);
}

} // namespace

Installed install(osg::Node& root, Scene& scene) {
    const osg::ref_ptr<Scene> keep = &scene; // that the root may have alone
    uninstall(root);
    hang(root, scene);
    const tss::SceneModel& model = scene.getModel();
    Installed installed;
    Machines machines(root, model);
    std::vector<PairPlace> kept;
    const auto place = [&](int p, bool nameless) {
        std::string why;
        const std::vector<PairPlace> places = machines.placesOf(p, why, nameless);
        for (const PairPlace& found : places) {
            machines.tag(found);
            if (model.pairs[p].table) kept.push_back(found);
        }
        if (!places.empty() && model.pairs[p].proof) ++installed.proven;
        return places.empty() ? why : "";
    };
    std::vector<int> missed; // once all that have their names are placed, among what has none
    for (std::size_t p = 0; p < model.pairs.size(); ++p) {
        if (!model.pairs[p].proof && !model.pairs[p].table)
            ++installed.unbaked;
        else if (!place(static_cast<int>(p), false).empty())
            missed.push_back(static_cast<int>(p));
    }
    for (const int p : missed) {
        const std::string why = place(p, true);
        if (why.empty()) continue;
        ++installed.stale;
        OSG_WARN << "osgTSS: pair " << model.pairs[p].path << " is not kept apart: " << why << std::endl;
    }
    for (const auto& group : grouped(kept)) installGroup(root, scene, group, installed);
    if (!kept.empty() || installed.proven > 0) {
        osg::ref_ptr<LimitsCallback> limits = new LimitsCallback(&scene);
        addOutermost(root, *limits);
        limits->start(root);
    }
    installSkins(root, scene, installed);
    if (installed.unbaked > 0)
        OSG_NOTICE << "osgTSS: " << installed.unbaked << " of " << model.pairs.size() + model.skins.size()
                   << " pairs and skins have no table and are not kept apart; 'tss bake' makes tables"
                   << std::endl;
    return installed;
}

Installed install(osg::Node& root, const tss::SceneModel& model) {
    osg::ref_ptr<Scene> scene = new Scene(std::make_shared<tss::SceneModel>(model));
    return install(root, *scene);
}

void uninstall(osg::Node& root) {
    eachNode(root, removeCallbacks);
    eachNode(root, takeOffScene);
    restoreDrawables(root);
}

} // namespace osgTSS
