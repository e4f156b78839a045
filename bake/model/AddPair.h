#pragma once
#include "bake/model/SceneModel.h"

#include <set>

namespace tss {

/// Adds the joints that spell a motion of body B against body A in terms of USD physics, places B at the
/// motion's rest values, and adds the pair. One joint prim when the DOFs share a centre and lie along the
/// axes of one frame; otherwise a chain of joints with an Xform between each two of them, and a pair prim
/// that names its ends. Bodies A and B must be in the scene, paths of siblings under /DEFAULTPRIM. `name`:
/// of the new prims. Returns the index of the pair. Throws InputError for a motion that checkMotion()
/// refuses, and for bodies that the scene does not have.
int addPair(SceneModel& scene, int bodyA, int bodyB, const Motion& motion, const std::string& name);

/// The joints alone, and no pair of them: indices into scene.joints, the chain from A to B. Body A may be -1,
/// the world. A motion without DOFs makes a fixed joint.
std::vector<int> addJoints(SceneModel& scene, int bodyA, int bodyB, const Motion& motion,
                           const std::string& name);

/// Adds a joint with its frames, DOFs and bodies as it is, but for its path, which `name` gives, and places
/// its body1 where the joint rests. Returns its index.
int addJoint(SceneModel& scene, Joint joint, const std::string& name);

/// A name that USD accepts ([A-Za-z_][A-Za-z0-9_]*), as near to the wanted one as can be, that no body, joint
/// or muscle of the scene has yet under the root prim.
std::string freePrimName(const SceneModel& scene, const std::string& wanted);

/// A motion to look at, for a scene without one of its own: one degree of freedom after the other goes from
/// rest to its lower limit, to its upper one and back, two seconds each, in the order of the scene's joints,
/// but for the `others`, which something else moves; then one muscle after the other contracts and lets go.
/// Ends where the last one does.
void addShowMotion(SceneModel& scene, const std::set<std::size_t>& others = {});

} // namespace tss
