// A baked scene in an application of one's own. Argument: the scene, scenes/dog_jaw_baked.tss for one.
#include <osgTSS/SceneFile>
#include <osgViewer/Viewer>

int main(int argc, char** argv) {
    osg::ArgumentParser arguments(&argc, argv);
    osg::ref_ptr<osgTSS::Scene> scene = osgTSS::readScene(argc > 1 ? argv[1] : "dog_jaw_baked.tss");
    osgViewer::Viewer viewer(arguments);
    viewer.setSceneData(osgTSS::createPlayingGraph(*scene));
    return viewer.run();
}
