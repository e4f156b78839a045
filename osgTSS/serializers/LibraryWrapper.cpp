#include <osgDB/Registry>

// For static builds: USE_SERIALIZER_WRAPPER_LIBRARY(osgTSS) in an application takes all of these along.
USE_SERIALIZER_WRAPPER(osgTSS_DriveCallback)
USE_SERIALIZER_WRAPPER(osgTSS_JointCallback)
USE_SERIALIZER_WRAPPER(osgTSS_JointTransform)
USE_SERIALIZER_WRAPPER(osgTSS_LimitsCallback)
USE_SERIALIZER_WRAPPER(osgTSS_MuscleCallback)
USE_SERIALIZER_WRAPPER(osgTSS_Overlay)
USE_SERIALIZER_WRAPPER(osgTSS_Scene)
USE_SERIALIZER_WRAPPER(osgTSS_SkinCallback)
USE_SERIALIZER_WRAPPER(osgTSS_SkinGeometry)
USE_SERIALIZER_WRAPPER(osgTSS_ViewerCallback)

extern "C" void wrapper_serializer_library_osgTSS(void) {}
