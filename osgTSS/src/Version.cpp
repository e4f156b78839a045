#include <osgTSS/Version>

const char* osgTSSGetVersion() {
    return OSGTSS_VERSION_STRING;
}

const char* osgTSSGetLibraryName() {
    return "OpenSceneGraph Tabulated Sphere Subset Library";
}
