// SPDX-License-Identifier: Apache-2.0
#include "assets/table/csv_file.hpp"

#include "assets/file/whole_file.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using table::with_plain_zeros;

TEST_CASE("zeros of a CSV file have no sign, however they are written, and nothing else changes") {
    CHECK(with_plain_zeros("a,b\n-0,-0.000\n-0e+00,-0.0E-3\n") == "a,b\n0,0.000\n0e+00,0.0E-3\n");
    CHECK(with_plain_zeros("-0") == "0");
    CHECK(with_plain_zeros("-0;-0\t-0\r\n-0") == "0;0\t0\r\n0");
    for (const char* kept : {"", "-0.001,-1,-10,-0.10", "-00a,--0,- 0,x-0,-", "\"a,-0\",\"-0\"\n",
                             "\"a \"\"-0\"\",-0\",-1", "2020-01-01,-0:30\n"}) {
        CAPTURE(kept);
        CHECK(with_plain_zeros(kept) == kept);
    }
    const TemporaryFolder folder;
    table::save_csv(folder / "a.csv", "x\n-0.0\n");
    CHECK(file::read_whole_file(folder / "a.csv") == "x\n0.0\n");
}
