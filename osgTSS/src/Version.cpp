#include <osgTSS/Version>

namespace osgTSS {

const char* getVersion() {
    return OSGTSS_VERSION_STRING;
}

} // namespace osgTSS
