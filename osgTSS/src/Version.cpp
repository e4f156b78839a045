#include <osgTSS/Version>

namespace osgTSS {

#define OSGTSS_TEXT_OF(x) #x
#define OSGTSS_TEXT(x) OSGTSS_TEXT_OF(x)

const char* getVersion() {
    return OSGTSS_TEXT(OSGTSS_MAJOR_VERSION) "." OSGTSS_TEXT(OSGTSS_MINOR_VERSION) "." OSGTSS_TEXT(
        OSGTSS_PATCH_VERSION);
}

} // namespace osgTSS
