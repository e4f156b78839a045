#pragma once
#include <osg/Group>

/// A tank as a program that never heard of osgTSS builds it: boxes and cylinders under osgSim::DOFTransforms.
/// The turret turns all the way round, the gun goes up and down; turned back and low, the gun would pass
/// through the stowage box on the rear deck. Metres, Z up.
osg::ref_ptr<osg::Group> makeTank();
