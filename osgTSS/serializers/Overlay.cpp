#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgTSS/Overlay>

// Without osg::Group: its children are made anew from the graph.
REGISTER_OBJECT_WRAPPER(osgTSS_Overlay, new osgTSS::Overlay, osgTSS::Overlay,
                        "osg::Object osg::Node osgTSS::Overlay") {
    ADD_OBJECT_SERIALIZER(Scene, osgTSS::Scene, nullptr);
}
