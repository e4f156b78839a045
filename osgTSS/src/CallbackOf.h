#pragma once
#include <osg/Callback>

#include <vector>

namespace osgTSS {

/// The first callback of a type among one and those nested in it, null when there is none.
template <class Type>
Type* callbackOf(osg::Callback* callback) {
    for (; callback; callback = callback->getNestedCallback())
        if (auto* found = dynamic_cast<Type*>(callback)) return found;
    return nullptr;
}

/// All of them.
template <class Type>
std::vector<Type*> callbacksOf(osg::Callback* callback) {
    std::vector<Type*> all;
    for (; callback; callback = callback->getNestedCallback())
        if (auto* found = dynamic_cast<Type*>(callback)) all.push_back(found);
    return all;
}

} // namespace osgTSS
