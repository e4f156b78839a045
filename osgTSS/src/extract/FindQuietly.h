#pragma once
#include <osgTSS/ConstraintVisitor>

namespace osgTSS {

/// What a visitor finds in a graph that has been looked at before: nobody is told again.
inline const tss::SceneModel& findQuietly(osg::Node& root, ConstraintVisitor& visitor,
                                          bool activeOnly = false) {
    visitor.setQuiet(true);
    visitor.setActiveOnly(activeOnly);
    root.accept(visitor);
    return visitor.getModel();
}

} // namespace osgTSS
