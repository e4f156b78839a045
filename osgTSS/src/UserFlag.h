#pragma once
#include <osg/ValueObject>

namespace osgTSS {

/// Whether an object has this user value, and it is true.
inline bool hasFlag(const osg::Object& object, const char* name) {
    bool value = false;
    return object.getUserValue(name, value) && value;
}

} // namespace osgTSS
