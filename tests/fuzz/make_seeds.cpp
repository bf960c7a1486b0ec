// SPDX-License-Identifier: Apache-2.0
// make_seeds FOLDER: writes the binary seeds of the fuzzers to FOLDER/<target>/.
#include "tests/fuzz/seeds.hpp"

int main(int count, char** words) {
    if (count != 2) return 1;
    tactus::write_seeds(words[1]);
}
