#pragma once
// Counts what the process asks of Vulkan: the executable's own vkQueueSubmit and so on take the calls of everything
// that is linked to it, count them and pass them on. And operator new.

struct Calls {
  int submits = 0, waits = 0, allocations = 0, objects = 0;  // objects: vkCreate*
  long heap = 0;                                             // operator new
};
extern Calls calls;
