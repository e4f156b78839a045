#include "TagCheck.h"

#include <osg/UserDataContainer>
#include <osg/ValueObject>

#include <algorithm>
#include <string_view>

namespace osgTSS {

namespace {

template <class Value>
bool is(const osg::Object& object) {
    return dynamic_cast<const osg::TemplateValueObject<Value>*>(&object);
}

struct Tag {
    std::string_view name;
    const char* type;
    bool (*fits)(const osg::Object& object);
};

constexpr auto isWords = is<std::string>;
constexpr auto isFlag = is<bool>;
constexpr auto isEither = [](const osg::Object& object) { return isWords(object) || isFlag(object); };
constexpr auto isPoint = [](const osg::Object& o) { return is<osg::Vec3d>(o) || is<osg::Vec3f>(o); };
constexpr auto isActivation = [](const osg::Object& object) {
    return is<double>(object) || is<float>(object) || isWords(object);
};

/// What an application sets.
constexpr Tag tags[] = {
    {"osgTSS:dofs", "a std::string", isWords},
    {"osgTSS:pivot", "an osg::Vec3d", isPoint},
    {"osgTSS:collides", "a std::string", isWords},
    {"osgTSS:limits", "a std::string", isWords},
    {"osgTSS:moved", "a bool", isFlag},
    {"osgTSS:static", "a bool", isFlag},
    {"osgTSS:ignored", "a bool", isFlag},
    {"osgTSS:still", "a double", is<double>},
    {"osgTSS:skin", "a bool or a std::string", isEither},
    {"osgTSS:muscle", "a bool or a std::string", isEither},
    {"osgTSS:bone", "a bool or a std::string", isEither},
    {"osgTSS:activation", "a double, a float or a std::string", isActivation},
};

/// What osgTSS itself remembers on nodes.
constexpr std::string_view own[] = {
    "osgTSS:rest",   "osgTSS:joint",  "osgTSS:body",   "osgTSS:bodyScale", "osgTSS:carrier",
    "osgTSS:frame0", "osgTSS:frame1", "osgTSS:stands", "osgTSS:hung",      "osgTSS:line",
};

std::string allTags() {
    std::string names;
    for (const Tag& tag : tags) names += (names.empty() ? "" : ", ") + std::string(tag.name);
    return names;
}

} // namespace

std::vector<std::string> wrongTags(const osg::Node& node) {
    std::vector<std::string> wrong;
    const osg::UserDataContainer* values = node.getUserDataContainer();
    for (unsigned int i = 0; values && i < values->getNumUserObjects(); ++i) {
        const osg::Object& value = *values->getUserObject(i);
        const std::string& name = value.getName();
        if (!name.starts_with("osgTSS:") || std::ranges::find(own, name) != std::end(own)) continue;
        const Tag* tag = std::ranges::find(tags, name, &Tag::name);
        if (tag == std::end(tags))
            wrong.push_back("user value \"" + name + "\" is none that is known: expected one of " +
                            allTags());
        else if (!tag->fits(value))
            wrong.push_back("user value \"" + name + "\" is passed over: expected " + tag->type);
    }
    return wrong;
}

} // namespace osgTSS
