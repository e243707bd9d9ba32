#pragma once
// A process that computes and does nothing else.

namespace gnomon {

// From here on this process, with all its threads and what they call, has memory, time, the descriptors it may read,
// and writing into `result`, standard output and standard error. Whatever else it asks of the system (to open, start,
// signal, connect, or make memory executable) fails with EPERM (seccomp(2)). Memory that it shares with others it
// shares still. False where the system has no such filters.
bool enterSandbox(int result);

}  // namespace gnomon
