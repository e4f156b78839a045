#include <osgTSS/ContactCallback>

namespace osgTSS {

ContactCallback::~ContactCallback() = default;

} // namespace osgTSS
