#include "PerNode.h"
#include "StandingParts.h"
#include "osgTSS/src/CallbackOf.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/extract/Machines.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osg/Node>
#include <osg/Notify>
#include <osg/observer_ptr>
#include <osgTSS/JointCallback>
#include <osgTSS/LimitsCallback>

#include <algorithm>

#include <set>

namespace osgTSS {

namespace {

bool standsOn(const osg::Node& node, const osg::Callback& callback) {
    const osg::Callback* at = node.getUpdateCallback();
    while (at && at != &callback) at = at->getNestedCallback();
    return at;
}

} // namespace

/// The joints of proofs below one node that can go beyond what the proofs are for, what stands there, and the
/// callbacks that hold joints.
struct LimitsCallback::Watch {
    struct Joint {
        std::string path, pair;
        std::unique_ptr<JointNode> node;
    };
    struct Holder {
        osg::observer_ptr<osg::Node> node;
        osg::ref_ptr<JointCallback> callback;
    };
    std::shared_ptr<const tss::SceneModel> model;
    std::vector<Joint> joints;
    std::vector<Holder> holders;
    StandingParts parts;
    bool updated = false; ///< there was an update since

    Watch(osg::Node& node, const Scene& scene) : model(scene.shareModel()), parts(node, *model) {
        const auto nodes = findJointNodes(node);
        std::set<int> known;
        for (const tss::Pair& pair : model->pairs) {
            if (!pair.proof) continue;
            for (int index : pair.joints) {
                const tss::Joint& joint = model->joints[index];
                const auto found = nodes.find(joint.path);
                if (found == nodes.end() || !known.insert(index).second) continue;
                for (osg::Node* carrier : found->second)
                    if (auto access = makeJointNode(*carrier, joint))
                        joints.push_back({joint.path, pair.path, std::move(access)});
            }
        }
        eachNode(node, [&](osg::Node& below) {
            for (JointCallback* holder : callbacksOf<JointCallback>(below.getUpdateCallback()))
                holders.push_back({&below, holder});
        });
    }

    /// What was not made for this graph.
    unsigned int tellUnfit(osg::Node& node) const {
        const std::vector<std::string> lines = Machines(node, *model).unknown();
        for (const std::string& line : lines) OSG_WARN << "osgTSS: " << line << std::endl;
        return static_cast<unsigned int>(lines.size());
    }

    /// Each joint is told of once, and then not looked at any more.
    unsigned int tell() {
        unsigned int told = 0;
        std::erase_if(joints, [&](const Joint& joint) {
            if (!joint.node->valid()) return true;
            const auto stray = joint.node->stray();
            if (!stray) return false;
            OSG_WARN << "osgTSS: joint " << joint.path << ": " << stray->what << "; pair " << joint.pair
                     << " is proven never to collide within its limits, and not there" << std::endl;
            ++told;
            return true;
        });
        if (const auto what = parts.changed()) {
            OSG_WARN << "osgTSS: " << *what << " when tables were installed; they know what was there then"
                     << std::endl;
            ++told;
        }
        return told;
    }
};

struct LimitsCallback::Watches : PerNode<Watch> {};

LimitsCallback::LimitsCallback() : _watches(std::make_unique<Watches>()) {}
LimitsCallback::~LimitsCallback() = default;

LimitsCallback::LimitsCallback(Scene* scene) : LimitsCallback() {
    _scene = scene;
}

LimitsCallback::LimitsCallback(const LimitsCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), SceneCallback(other, copyop), _watches(std::make_unique<Watches>()) {}

void LimitsCallback::setScene(Scene* scene) {
    SceneCallback::setScene(scene);
    _watches->clear();
}

LimitsCallback::Watch& LimitsCallback::watchOf(osg::Node& node) {
    return _watches->of(
        node, [&](const Watch*) { return std::make_unique<Watch>(node, *_scene); },
        [&](const Watch& made) { return made.model == _scene->shareModel(); });
}

/// The joints once more that something has moved after they were held. Contact callbacks of the application
/// hear of it, which may change what is installed.
unsigned int LimitsCallback::hold(osg::Node& root, osg::NodeVisitor& visitor) {
    unsigned int told = 0;
    std::vector<Watch::Holder> holders = std::move(watchOf(root).holders);
    std::erase_if(holders, [&](const Watch::Holder& holder) {
        osg::ref_ptr<osg::Node> node;
        if (!holder.node.lock(node)) return true;
        if (!isBelow(*node, root)) return false;
        if (standsOn(*node, *holder.callback)) {
            holder.callback->hold(*node, visitor);
            return false;
        }
        if (!standsOn(root, *this)) return true; // all of it was taken away
        OSG_WARN << "osgTSS: the update callback that keeps joints below node \"" << node->getName()
                 << "\" apart was taken from it; expected addUpdateCallback() for others" << std::endl;
        ++told;
        return true;
    });
    if (_scene && watchOf(root).holders.empty()) watchOf(root).holders = std::move(holders);
    return told;
}

void LimitsCallback::start(osg::Node& node) {
    _watches->erase(node);
    if (_scene) watchOf(node);
}

bool LimitsCallback::run(osg::Object* object, osg::Object* data) {
    const osg::ref_ptr<LimitsCallback> self(this); // an application may take it from its node meanwhile
    const bool result = traverse(object, data);
    osg::Node* node = object ? object->asNode() : nullptr;
    if (!node || !_scene) return result;
    osg::NodeVisitor* visitor = data ? data->asNodeVisitor() : nullptr;
    const bool started = _watches->find(*node) != nullptr;
    Watch* watch = &watchOf(*node);
    if (!watch->updated) {
        if (!started || watch->parts.anyOther()) {
            _warnings += watch->tellUnfit(*node);
            _watches->erase(*node);
            watch = &watchOf(*node); // from what is there now
        }
        watch->updated = true;
    }
    if (visitor) _warnings += hold(*node, *visitor);
    if (_scene) _warnings += watchOf(*node).tell();
    return result;
}

} // namespace osgTSS
