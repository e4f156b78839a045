#include "bake/scene/SceneFile.h"

#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/extract/FindQuietly.h"

#include <osg/Notify>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/SceneFile>
#include <osgTSS/ViewerCallback>

#include <set>

namespace osgTSS {

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
    ConstraintVisitor visitor;
    std::set<Scene*> found;
    eachNode(root, [&](osg::Node& node) {
        if (Scene* scene = Scene::on(node)) found.insert(scene);
    });
    if (found.size() > 1)
        throw tss::InputError("the graph holds " + std::to_string(found.size()) +
                              " scenes: expected one a file; write the node of each by itself");
    if (found.empty()) {
        root.accept(visitor);
        return new Scene(std::make_shared<tss::SceneModel>(visitor.getModel()));
    }
    // What has come since it was installed, or stands around it, is missing in the scene.
    Scene& scene = **found.begin();
    const std::size_t joints = findQuietly(root, visitor).joints.size(),
                      known = scene.getModel().joints.size();
    if (joints > known)
        OSG_WARN << "osgTSS: the scene that is written has " << known << " joints, and the graph " << joints
                 << ": expected its node alone, or install() of what all of it is baked to" << std::endl;
    return &scene;
}

void writeScene(osg::Node& root, const std::string& file) {
    tss::saveScene(sceneOf(root)->getModel(), file);
}

} // namespace osgTSS
