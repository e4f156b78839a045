#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgTSS/SkinGeometry>

REGISTER_OBJECT_WRAPPER(osgTSS_SkinGeometry, new osgTSS::SkinGeometry, osgTSS::SkinGeometry,
                        "osg::Object osg::Node osg::Drawable osgTSS::SkinGeometry") {
    ADD_STRING_SERIALIZER(Path, "");
    ADD_OBJECT_SERIALIZER(RestGeometry, osg::Geometry, nullptr);
}
