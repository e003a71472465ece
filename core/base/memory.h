#pragma once

namespace lpf {

/// Gives back what the allocator keeps of freed memory, so that large steps one after the other
/// need no more than the largest of them. Costs milliseconds; does nothing where there is no way.
void return_freed_memory();

}  // namespace lpf
