#include "BoneMotion.h"

#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/draw/BodyNodes.h"

#include <osg/UserDataContainer>
#include <osgAnimation/RigGeometry>

#include <cmath>

namespace osgTSS {

namespace {

using osgAnimation::Bone;

bool holdsVertices(osg::Node& node, const std::string& bone) {
    osg::Drawable* drawable = node.asDrawable();
    if (drawable && replacedBy(*drawable)) drawable = replacedBy(*drawable);
    const auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(drawable);
    return rig && rig->getInfluenceMap() && rig->getInfluenceMap()->contains(bone);
}

bool standsAtOrigin(Bone& bone) {
    osg::Matrixd inSkeleton;
    for (Bone* at = &bone; at; at = at->getBoneParent()) inSkeleton = inSkeleton * boneNow(*at);
    for (int i = 0; i < 16; ++i)
        if (std::abs(inSkeleton.ptr()[i] - (i % 5 == 0 ? 1 : 0)) > 1e-6) return false;
    return true;
}

/// The identity is what a bone has that was told nothing, as in a file of motions without a mesh. It counts
/// where a mesh names the bone, or where the bone stands there among others that were told.
bool isBound(Bone& bone) {
    if (!bone.getInvBindMatrixInSkeletonSpace().isIdentity()) return true;
    osg::Node* skeleton = skeletonOf(bone);
    if (!skeleton) return false;
    bool named = false, told = false;
    eachNode(*skeleton, [&](osg::Node& node) {
        named = named || holdsVertices(node, bone.getName());
        const auto* other = dynamic_cast<const Bone*>(&node);
        told = told || (other && !other->getInvBindMatrixInSkeletonSpace().isIdentity());
    });
    return named || (told && standsAtOrigin(bone));
}

} // namespace

osgAnimation::Skeleton* skeletonOf(osg::Node& bone) {
    for (osg::Node* at = &bone; at->getNumParents() > 0;) {
        at = at->getParent(0);
        if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(at)) return skeleton;
    }
    return nullptr;
}

std::optional<osg::Matrixd> boneBound(Bone& bone) {
    if (!isBound(bone)) return std::nullopt;
    const osg::Matrixd bound = osg::Matrixd::inverse(bone.getInvBindMatrixInSkeletonSpace());
    Bone* parent = bone.getBoneParent();
    if (!parent) return bound;
    if (!isBound(*parent)) return std::nullopt;
    return bound * parent->getInvBindMatrixInSkeletonSpace();
}

bool wearsSkin(Bone& bone) {
    osg::Node* skeleton = skeletonOf(bone);
    bool found = false;
    if (skeleton)
        eachNode(*skeleton, [&](osg::Node& node) {
            const osg::UserDataContainer* values = node.asDrawable() ? node.getUserDataContainer() : nullptr;
            found = found || (values && values->getUserObject("osgTSS:skin"));
        });
    return found;
}

} // namespace osgTSS
