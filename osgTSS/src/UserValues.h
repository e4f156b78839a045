#pragma once
#include <osg/UserDataContainer>
#include <osg/ValueObject>

namespace osgTSS {

/// Whether an object has this user value, and it is true.
inline bool hasFlag(const osg::Object& object, const char* name) {
    bool value = false;
    return object.getUserValue(name, value) && value;
}

/// The first user object of a type; null: there is none.
template <class Type>
Type* userObjectOf(osg::Object& object) {
    osg::UserDataContainer* container = object.getUserDataContainer();
    for (unsigned int k = 0; container && k < container->getNumUserObjects(); ++k)
        if (auto* found = dynamic_cast<Type*>(container->getUserObject(k))) return found;
    return nullptr;
}

} // namespace osgTSS
