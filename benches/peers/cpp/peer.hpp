// Shared by the C++ engines: the neutral file, the frame loop with its clock, the trajectory. The same protocol as in
// python/adapter.py:  ENGINE WORKLOAD.json LIMIT OUTPUT key=value …  prints CPU seconds and the reason of an early end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

using Numbers = std::vector<double>;

struct Workload {
    int dimension;
    double frame;  // s
    int frames;
    Numbers gravity, positions, masses, lengths;
    std::vector<int> fixed, ends;

    explicit Workload(const std::string& path) {
        std::ifstream file(path);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        dimension = static_cast<int>(read(text, "dimension").at(0));
        frame = read(text, "frame").at(0);
        frames = static_cast<int>(read(text, "frames").at(0));
        gravity = read(text, "gravity");
        positions = read(text, "positions");
        masses = read(text, "masses");
        lengths = read(text, "lengths");
        for (double flag : read(text, "fixed")) fixed.push_back(static_cast<int>(flag));
        for (double end : read(text, "ends")) ends.push_back(static_cast<int>(end));
    }

    int particles() const { return static_cast<int>(masses.size()); }
    int rods() const { return static_cast<int>(lengths.size()); }
    double inverse_mass(int particle) const { return fixed[particle] ? 0.0 : 1.0 / masses[particle]; }

private:
    // Every value of the neutral file is a number or a flat list of numbers, so a reader for this part of JSON is
    // enough.
    static Numbers read(const std::string& text, const std::string& key) {
        const std::string quoted = "\"" + key + "\":";
        const auto found = text.find(quoted);
        if (found == std::string::npos) throw std::runtime_error("the workload has no " + key);
        const char* at = text.c_str() + found + quoted.size();
        const bool list = *at == '[';
        Numbers numbers;
        do {
            if (list) ++at;
            char* after = nullptr;
            const double number = std::strtod(at, &after);
            if (after == at) break;  // an empty list
            numbers.push_back(number);
            at = after;
        } while (list && *at == ',');
        return numbers;
    }
};

struct State {
    Numbers q, qd;
};

// Advances by one frame; throws std::runtime_error if it cannot.
using Frame = std::function<void(State&)>;
using Setting = std::map<std::string, std::string>;

// CPU time [s]. std::clock counts microseconds, which is too coarse: a frame of a small workload takes as long.
inline double cpu_now() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

inline int peer_main(int count, char** words, const std::function<Frame(const Workload&, const Setting&)>& begin) {
    constexpr int runs = 3;  // number of runs if a run takes under a second; the fastest counts
    const Workload workload(words[1]);
    const double limit = std::stod(words[2]);
    Setting setting;
    for (int i = 4; i < count; ++i) {
        const std::string word = words[i];
        setting[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
    }
    double total = 0.0, best = std::numeric_limits<double>::infinity();
    std::string ended;
    Numbers written;
    for (int run = 0; run < runs && ended.empty() && total < 1.0; ++run) {
        const Frame frame = begin(workload, setting);
        State state{workload.positions, Numbers(workload.positions.size(), 0.0)};
        written.clear();
        double cpu = 0.0;
        for (int done = 1; done <= workload.frames && ended.empty(); ++done) {
            const double start = cpu_now();
            try {
                frame(state);
            } catch (const std::runtime_error& error) {
                ended = error.what();
            }
            cpu += cpu_now() - start;
            const auto finite = [](double number) { return std::isfinite(number); };
            if (ended.empty() && !(std::all_of(state.q.begin(), state.q.end(), finite) &&
                                   std::all_of(state.qd.begin(), state.qd.end(), finite)))
                ended = "diverged";
            if (!ended.empty()) break;
            written.insert(written.end(), state.q.begin(), state.q.end());
            written.insert(written.end(), state.qd.begin(), state.qd.end());
            // After a tenth of the limit it is clear whether a run will take one and a half times the limit.
            const double estimate = cpu / done * workload.frames;
            if (done < workload.frames && (cpu > limit || (cpu > limit / 10 && estimate > 1.5 * limit)))
                ended = "too slow: about " + std::to_string(std::lround(estimate)) + " s of CPU time";
        }
        total += cpu;
        best = std::min(best, cpu);
    }
    std::ofstream(words[3], std::ios::binary)
        .write(reinterpret_cast<const char*>(written.data()),
               static_cast<std::streamsize>(written.size() * sizeof(double)));
    std::printf("%.9f %s\n", best, ended.c_str());
    return 0;
}
