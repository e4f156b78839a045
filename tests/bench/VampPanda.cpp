// Apart from the rest, as VAMP wants its own options of the compiler.
#include "tests/bench/VampPanda.h"

#include <vamp/robots/panda.hh>

using Lanes = vamp::FloatVector<8, 1>;
using vamp::robots::Panda;

namespace vamp_panda {
namespace {

bool touches(const Panda::ConfigurationBlock<8>& block) {
    static const vamp::collision::Environment<vamp::FloatVector<8>> nothing;
    return !Panda::fkcc<8>(nothing, block);
}

} // namespace

bool touches(const double* q) {
    Panda::ConfigurationBlock<8> block;
    for (std::size_t k = 0; k < 7; ++k) block[k] = Lanes::fill(static_cast<float>(q[k]));
    return touches(block);
}

bool anyTouches(const Eight& q) {
    Panda::ConfigurationBlock<8> block;
    for (std::size_t k = 0; k < 7; ++k) block[k] = Lanes(q.joints[k].data());
    return touches(block);
}

} // namespace vamp_panda
