#pragma once

namespace osgTSS {

/// OpenSceneGraph writes its old formats, .osg and .ive, without what they do not know, and says nothing of
/// it: from here on a warning names what is left out. Of an .ive where its plugin was not loaded before this
/// library.
void warnOfOldFormats();

} // namespace osgTSS
