#include "BodyNodes.h"
#include "JointNodes.h"

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/JointCallback>
#include <osgTSS/SkinCallback>

#include <algorithm>
#include <numeric>

namespace osgTSS {

namespace {

/// Pairs with a table, grouped so that pairs that share a joint are together; groups and pairs in the scene's
/// order.
std::vector<std::vector<int>> groupPairs(const tss::SceneModel& model) {
    std::vector<int> group(model.pairs.size());
    std::iota(group.begin(), group.end(), 0);
    std::vector<int> firstOfJoint(model.joints.size(), -1);
    const auto root = [&](int i) {
        while (group[i] != i) i = group[i];
        return i;
    };
    for (std::size_t p = 0; p < model.pairs.size(); ++p) {
        if (!model.pairs[p].table) continue;
        for (int joint : model.pairs[p].joints) {
            int& first = firstOfJoint[joint];
            if (first < 0) first = static_cast<int>(p);
            const int a = root(first), b = root(static_cast<int>(p));
            group[std::max(a, b)] = std::min(a, b);
        }
    }
    std::vector<std::vector<int>> groups(model.pairs.size());
    for (std::size_t p = 0; p < model.pairs.size(); ++p)
        if (model.pairs[p].table) groups[root(static_cast<int>(p))].push_back(static_cast<int>(p));
    std::erase_if(groups, [](const auto& pairs) { return pairs.empty(); });
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
            std::erase_if(common,
                          [&](osg::Node* n) { return std::find(path.begin(), path.end(), n) == path.end(); });
        }
    return common.empty() ? &root : common.back();
}

/// Ours runs around those that are there, so that it has the last word whatever they do after their own
/// traverse().
void addOutermost(osg::Node& node, osg::Callback& callback) {
    if (osg::Callback* others = node.getUpdateCallback()) callback.addNestedCallback(others);
    node.setUpdateCallback(&callback);
}

/// Joints and bodies of a graph that knows nothing of us: extracted again, and tagged where the scene has one
/// of that path.
void tagPlainNodes(osg::Node& root, const tss::SceneModel& model) {
    ConstraintVisitor visitor;
    root.accept(visitor);
    const tss::SceneModel& found = visitor.getModel();
    const auto known = [](const auto& items, const std::string& path) {
        return std::any_of(items.begin(), items.end(), [&](const auto& item) { return item.path == path; });
    };
    for (std::size_t j = 0; j < found.joints.size(); ++j)
        if (known(model.joints, found.joints[j].path))
            tagJoint(*visitor.getJointNodes()[j], found.joints[j].path);
    for (std::size_t b = 0; b < found.bodies.size(); ++b) {
        const ConstraintVisitor::BodyNode& at = visitor.getBodyNodes()[b];
        if (at.node && known(model.bodies, found.bodies[b].path))
            tagBody(*at.node, found.bodies[b].path, at.scale);
    }
}

class RemoveCallbacks : public osg::NodeVisitor {
public:
    RemoveCallbacks() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override {
        osg::ref_ptr<osg::Callback> callback = node.getUpdateCallback();
        while (callback) {
            osg::ref_ptr<osg::Callback> next = callback->getNestedCallback();
            const bool ours =
                dynamic_cast<JointCallback*>(callback.get()) || dynamic_cast<SkinCallback*>(callback.get());
            if (ours) node.removeUpdateCallback(callback);
            callback = next;
        }
        traverse(node);
    }
};

bool allFound(const tss::SceneModel& model, const std::vector<std::vector<int>>& groups,
              const std::map<std::string, osg::Node*>& nodes) {
    for (const auto& pairs : groups)
        for (int pair : pairs)
            for (int joint : model.pairs[pair].joints)
                if (!nodes.contains(model.joints[joint].path)) return false;
    return true;
}

void installGroup(osg::Node& root, Scene& scene, const std::vector<int>& pairs,
                  const std::map<std::string, osg::Node*>& nodes, Installed& installed) {
    const tss::SceneModel& model = scene.getModel();
    std::vector<osg::Node*> joints;
    std::vector<std::string> paths;
    for (int index : pairs) {
        const tss::Pair& pair = model.pairs[index];
        const auto missing = std::find_if(pair.joints.begin(), pair.joints.end(), [&](int joint) {
            return !nodes.contains(model.joints[joint].path);
        });
        if (missing != pair.joints.end()) {
            OSG_WARN << "osgTSS: pair " << pair.path << ": no node of the graph carries joint "
                     << model.joints[*missing].path << std::endl;
            continue;
        }
        for (int joint : pair.joints) joints.push_back(nodes.at(model.joints[joint].path));
        paths.push_back(pair.path);
    }
    if (paths.empty()) return;
    installed.joints += static_cast<unsigned int>(paths.size());
    osg::Node& node = *lowestAbove(root, joints);
    osg::ref_ptr<JointCallback> callback = new JointCallback(&scene, paths);
    addOutermost(node, *callback);
    callback->start(node);
}

/// On the root: a skin is deformed after everything else of the scene has found its place.
void installSkins(osg::Node& root, Scene& scene, Installed& installed) {
    for (const tss::SkinModel& skin : scene.getModel().skins) {
        if (!skin.table) {
            ++installed.unbaked;
            continue;
        }
        osg::ref_ptr<SkinCallback> callback = new SkinCallback(&scene, skin.path);
        addOutermost(root, *callback);
        ++installed.skins;
    }
}

} // namespace

Installed install(osg::Node& root, Scene& scene) {
    uninstall(root);
    scene.attachTo(root);
    const tss::SceneModel& model = scene.getModel();
    Installed installed;
    for (const tss::Pair& pair : model.pairs) {
        if (pair.proof) ++installed.proven;
        if (!pair.proof && !pair.table) ++installed.unbaked;
    }
    const auto groups = groupPairs(model);
    auto nodes = findJointNodes(root);
    if (!allFound(model, groups, nodes)) {
        tagPlainNodes(root, model);
        nodes = findJointNodes(root);
    }
    for (const auto& pairs : groups) installGroup(root, scene, pairs, nodes, installed);
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
    RemoveCallbacks visitor;
    root.accept(visitor);
}

} // namespace osgTSS
