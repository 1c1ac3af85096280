// Threads of this process, as the system lists them.
#pragma once

#include <chrono>
#include <dirent.h>
#include <thread>

namespace abacus::test {

inline int threads_now() {
    int n = 0;
    DIR *const tasks = opendir("/proc/self/task");
    while (const dirent *entry = readdir(tasks)) n += entry->d_name[0] != '.';
    closedir(tasks);
    return n;
}

/// A sanitizer adds one thread to the first.
inline const int threads_at_first = [] {
    std::thread([] {}).join();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return threads_now();
}();

/// The system may list a thread for a moment after it has been joined.
inline bool all_threads_ended() {
    for (int tries = 0; tries < 1000; ++tries) {
        if (threads_now() == threads_at_first) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

} // namespace abacus::test
