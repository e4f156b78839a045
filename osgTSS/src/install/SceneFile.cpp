#include "bake/scene/SceneFile.h"

#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/extract/FindQuietly.h"
#include "osgTSS/src/extract/Machines.h"

#include <osg/Notify>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/SceneFile>
#include <osgTSS/ViewerCallback>

#include <map>

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

namespace {

std::size_t trianglesIn(const tss::SceneModel& model) {
    std::size_t count = 0;
    for (const tss::Body& body : model.bodies) count += body.mesh.triangles.size();
    return count;
}

/// What has come or become other in a graph since its scene was installed, or stands around it: it is not
/// written.
void tellUnwritten(osg::Node& root, osg::Node& node, const tss::SceneModel& written) {
    ConstraintVisitor visitor;
    const tss::SceneModel& found = findQuietly(root, visitor);
    const auto tell = [](std::size_t known, std::size_t there, const char* what) {
        if (there > known)
            OSG_WARN << "osgTSS: the scene that is written has " << known << " " << what << ", and the graph "
                     << there << ": expected its node alone, or install() of what all of it is baked to"
                     << std::endl;
    };
    tell(written.joints.size(), found.joints.size(), "joints");
    tell(trianglesIn(written), trianglesIn(found), "triangles");
    for (const std::string& line : Machines(node, written).unknown())
        OSG_WARN << "osgTSS: the scene is written as it was baked; " << line << std::endl;
}

} // namespace

osg::ref_ptr<Scene> sceneOf(osg::Node& root) {
    std::map<Scene*, osg::Node*> found;
    eachNode(root, [&](osg::Node& node) {
        if (Scene* scene = Scene::on(node)) found.emplace(scene, &node);
    });
    if (found.size() > 1)
        throw tss::InputError("the graph holds " + std::to_string(found.size()) +
                              " scenes: expected one a file; write the node of each by itself");
    if (found.empty()) {
        ConstraintVisitor visitor;
        root.accept(visitor);
        return new Scene(std::make_shared<tss::SceneModel>(visitor.getModel()));
    }
    const auto& [scene, node] = *found.begin();
    tellUnwritten(root, *node, scene->getModel());
    return scene;
}

void writeScene(osg::Node& root, const std::string& file) {
    tss::saveScene(sceneOf(root)->getModel(), file);
}

} // namespace osgTSS
