// Those of the other tests and of the node kit, whose flags are its own.
#include "osgTSS/Precompiled.h"
#include "tests/Precompiled.h"
