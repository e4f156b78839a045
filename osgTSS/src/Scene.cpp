#include "OldFormats.h"
#include "SceneCache.h"
#include "UserValues.h"

#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/WriteLayer.h"

#include <osgTSS/Scene>

#include <cmath>

namespace osgTSS {

Scene::Scene() : Scene(std::make_shared<tss::SceneModel>()) {}

Scene::~Scene() = default;

Scene::Scene(std::shared_ptr<const tss::SceneModel> model, Clock::Source source)
    : _model(std::move(model)), _clock(*_model, source), _cache(std::make_shared<Cache>(_model)) {
    warnOfOldFormats();
}

Scene::Scene(const Scene& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), _model(other._model), _clock(other._clock),
      _activations(other._activations), _contactCallback(other._contactCallback), _cache(other._cache) {}

void Scene::setModel(std::shared_ptr<const tss::SceneModel> model) {
    _model = model ? std::move(model) : std::make_shared<const tss::SceneModel>();
    _clock = Clock(*_model, _clock.source);
    _activations.clear();
    _cache = std::make_shared<Cache>(_model);
}

double Scene::getActivation(int muscle, double timeCode) const {
    const auto set = _activations.find(muscle);
    if (set != _activations.end()) return set->second;
    const bool known = muscle >= 0 && static_cast<std::size_t>(muscle) < _model->muscles.size();
    return known ? _model->muscles[muscle].activation.at(timeCode) : 0;
}

void Scene::setActivation(int muscle, double activation) {
    if (std::isfinite(activation)) _activations[muscle] = activation;
}

void Scene::setText(const std::string& text) {
    const std::string name = getName().empty() ? "scene in memory" : getName();
    auto layer = std::make_shared<const tss::Layer>(tss::parseLayer(text, name));
    setModel(std::make_shared<const tss::SceneModel>(tss::readScene(layer, name)));
}

std::string Scene::getText() const {
    return tss::writeJson(tss::layerOf(*_model));
}

void Scene::attachTo(osg::Node& node) {
    osg::ref_ptr<Scene> keep = this;
    osg::UserDataContainer* container = node.getOrCreateUserDataContainer();
    while (Scene* before = on(node)) container->removeUserObject(container->getUserObjectIndex(before));
    container->addUserObject(this);
}

Scene* Scene::on(const osg::Node& node) {
    return userObjectOf<Scene>(const_cast<osg::Node&>(node));
}

} // namespace osgTSS
