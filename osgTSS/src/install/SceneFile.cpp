#include "bake/scene/SceneFile.h"

#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"

#include <osg/NodeVisitor>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/SceneFile>
#include <osgTSS/ViewerCallback>

#include <set>

namespace osgTSS {

namespace {

class FindScenes : public osg::NodeVisitor {
public:
    FindScenes() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Node& node) override {
        if (Scene* scene = Scene::on(node)) found.insert(scene);
        traverse(node);
    }
    std::set<Scene*> found;
};

} // namespace

osg::ref_ptr<Scene> readScene(const std::string& file) {
    auto model = std::make_shared<tss::SceneModel>(tss::loadScene(file));
    tss::requireFresh(*model, file);
    return new Scene(model);
}

osg::ref_ptr<osg::Group> createPlayingGraph(Scene& scene, const LoadOptions& options) {
    scene.setClock(Clock(scene.getModel(), options.clock));
    osg::ref_ptr<osg::Group> root = createGraph(scene, options.graph);
    install(*root, scene);
    addViewerAids(*root, scene, options.overlay);
    return root;
}

osg::ref_ptr<Scene> sceneOf(osg::Node& root) {
    FindScenes finder;
    root.accept(finder);
    if (finder.found.size() > 1)
        throw tss::InputError("the graph holds " + std::to_string(finder.found.size()) +
                              " scenes: expected one a file; write the node of each by itself");
    if (!finder.found.empty()) return *finder.found.begin();
    ConstraintVisitor visitor;
    root.accept(visitor);
    return new Scene(std::make_shared<tss::SceneModel>(visitor.getModel()));
}

void writeScene(osg::Node& root, const std::string& file) {
    tss::saveScene(sceneOf(root)->getModel(), file);
}

} // namespace osgTSS
