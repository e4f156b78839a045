#pragma once
#include <osg/Callback>

namespace osgTSS {

/// The first callback of a type among one and those nested in it, null when there is none.
template <class Type>
Type* callbackOf(osg::Callback* callback) {
    for (; callback; callback = callback->getNestedCallback())
        if (auto* found = dynamic_cast<Type*>(callback)) return found;
    return nullptr;
}

} // namespace osgTSS
