#!/usr/bin/env python3
"""The pieces of docs/guide.md are a case that runs, put together or as files of their own, and writes the files it names."""
import os
import re
import sys
import tempfile

import one_case

SILT = sys.argv[1]
GUIDE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "guide.md")


def main():
    text = open(GUIDE).read()
    pieces = re.findall(r"^```yaml\n(.*?)^```", text, flags=re.M | re.S)
    assert len(pieces) == 6, len(pieces)
    table = text[text.index("In the output directory") : text.index("## 6.")]
    named = re.findall(r"`([a-z_]+\.[a-z0-9]+)`", table)
    assert len(named) == 11, named
    with tempfile.TemporaryDirectory() as folder:
        one_case.write_case(folder, "\n".join(pieces))
        code, said = one_case.run(SILT, folder, "-check")
        assert code == 0 and "the case is valid" in said, said
        code, together = one_case.run(SILT, folder, "-time_end", "0.003", "-settle_time", "0.01", "-expect_pressure_drop_window", "0,0.003",
                                      "-expect_warm_air_stays_below_at", "0.003")
        assert "step 3" in together, together
        missing = [name for name in named if not os.path.exists(os.path.join(folder, "output", "guide", name))]
        assert not missing, missing
        for k, piece in enumerate(pieces):
            with open(os.path.join(folder, f"piece{k}.yaml"), "w") as file:
                file.write(piece)
        parts = [f"piece{k}.yaml" for k in range(1, len(pieces))]
        os.rename(os.path.join(folder, "piece0.yaml"), os.path.join(folder, "case.yaml"))
        code, apart = one_case.run(SILT, folder, *parts, "-check")
        assert code == 0 and apart == said, apart + said
    print("the guide's case runs")


main()
