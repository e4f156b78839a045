#pragma once
#include "bake/scene/SceneParts.h"

#include <vector>

namespace tss {

/// The prim is of no type, or an Xform or Scope.
bool isGroup(const Prim& prim);

/// What of a stage collides. Entries as in the reading's index, which must outlive this.
class Colliders {
public:
    explicit Colliders(const SceneReading& reading);

    /// It has PhysicsCollisionAPI, switched on or not.
    bool is(std::size_t entry) const { return holds_[entry] == Own; }
    /// It collides itself, or is part of what does: of a prim above it that is no shape.
    bool collides(std::size_t entry) const;
    /// A PointInstancer has copies of what is below it, and not that itself.
    bool isPrototype(std::size_t entry) const;
    /// Of an instancer: below it, or where its prototypes are, some prim has PhysicsCollisionAPI.
    bool hasCollidingPrototypes(std::size_t instancer) const;

private:
    enum Holds : char { None, Below, Own };
    const SceneReading& reading_;
    std::vector<Holds> holds_; ///< one per entry: PhysicsCollisionAPI itself, or somewhere below it
};

} // namespace tss
