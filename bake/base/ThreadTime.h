#pragma once

namespace tss {

/// Seconds that this thread has run: another program that takes its turn in between does not count.
double threadSeconds();

} // namespace tss
