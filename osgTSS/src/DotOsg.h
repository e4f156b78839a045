#pragma once

namespace osgTSS {

/// OpenSceneGraph writes its old format (.osg) without what it has no wrapper for, and says nothing of it:
/// from here on a warning names what is left out.
void warnOfDotOsg();

} // namespace osgTSS
