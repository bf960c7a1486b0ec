// SPDX-License-Identifier: Apache-2.0
#include "tools/verbs.hpp"

int main(int argc, char** argv) { return tactus::command_line(argc, argv); }
