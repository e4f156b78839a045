#include "PerNode.h"
#include "StandingParts.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osg/Node>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgTSS/LimitsCallback>

#include <set>

namespace osgTSS {

/// The joints of proofs below one node that can go beyond what the proofs are for, and what stands there.
struct LimitsCallback::Watch {
    struct Joint {
        std::string path, pair;
        std::unique_ptr<JointNode> node;
    };
    std::shared_ptr<const tss::SceneModel> model;
    std::vector<Joint> joints;
    StandingParts parts;

    Watch(osg::Node& node, const Scene& scene) : model(scene.shareModel()), parts(node, *model) {
        const auto nodes = findAllJointNodes(node);
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
    : osg::Object(other, copyop), osg::Callback(other, copyop), _scene(other._scene),
      _watches(std::make_unique<Watches>()) {}

void LimitsCallback::setScene(Scene* scene) {
    _scene = scene;
    _watches->clear();
}

bool LimitsCallback::run(osg::Object* object, osg::Object* data) {
    const osg::ref_ptr<LimitsCallback> self(this); // an application may take it from its node meanwhile
    const bool result = traverse(object, data);
    osg::Node* node = object ? object->asNode() : nullptr;
    if (!node || !_scene) return result;
    Watch& watch = _watches->of(
        *node, [&](const Watch*) { return std::make_unique<Watch>(*node, *_scene); },
        [&](const Watch& made) { return made.model == _scene->shareModel(); });
    _warnings += watch.tell();
    return result;
}

} // namespace osgTSS
