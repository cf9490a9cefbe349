# Measurements: short ones, what they look like, and what is typed wrongly.

A table
  $ ptie bench --only peak --time 1ms --threads 2
  ptie 0.1.0, commit *, * (glob)
  *, 2 threads, 0.001 s per measurement (glob)
  
  *threads   median * range   GFLOP/s   of peak (glob)
  peak * (glob)
    multiply-add, 1 thread * 1 * GFLOP/s * (glob)
    multiply-add, all threads * 2 * GFLOP/s * (glob)
    memory copy, all threads * 2 * GB/s * (glob)

A table for a Markdown file
  $ ptie bench --only peak --time 1ms --markdown | tail -n +3 | head -4
  |  | threads | median |  | range | GFLOP/s | of peak |
  |:--|--:|--:|--:|--:|--:|--:|
  | **peak** |  |  |  |  |  |  |
  |   multiply-add, 1 thread | 1 | * | GFLOP/s | * |  |  | (glob)

JSON is what docs/bench.md says
  $ ptie bench --only solving,inference --time 1ms -T 1 --json - > all.json
  $ python3 - <<'END'
  > import json
  > top = json.load(open("all.json"))
  > number, none = (int, float), type(None)
  > expected = {"version": str, "commit": str, "compiler": str, "processor": str, "level": str,
  >             "threads": int, "seconds": number, "results": list}
  > assert list(top) == list(expected), list(top)
  > assert all(isinstance(top[key], kind) for key, kind in expected.items())
  > assert top["threads"] == 1 and top["seconds"] == 0.001
  > maybe = (int, float, none)
  > fields = {"group": str, "name": str, "unit": str, "threads": int, "samples": int, "median": maybe,
  >           "low": maybe, "high": maybe, "gflops": maybe, "peak_gflops": maybe, "peak_share": maybe}
  > for result in top["results"]:
  >     assert list(result) == list(fields), result
  >     assert all(isinstance(result[key], kind) for key, kind in fields.items()), result
  >     assert (result["gflops"] is None) == (result["peak_share"] is None), result
  > names = [(r["group"], r["name"]) for r in top["results"]]
  > assert len(set(names)) == len(names)
  > print(sorted({r["group"] for r in top["results"]}))
  > END
  ['inference', 'solving']

JSON beside the table, whole or not at all
  $ ptie bench --only peak --time 1ms --cpu scalar --json out.json | wc -l
  8
  $ python3 -c 'import json; top = json.load(open("out.json")); print(top["level"], len(top["results"]))'
  scalar 3
  $ ptie bench --only peak --json out.json
  ! ptie: out.json: exists already (use -f to overwrite)
  [1]
  $ ptie bench --only peak --json no/where.json
  ! ptie: no/where.json: cannot create: No such file or directory
  [1]
  $ ptie bench --only peek --json other.json
  ! ptie: bench: unknown group 'peek' (did you mean 'peak'?)
  [2]
  $ ls
  out.json

What is typed wrongly
  $ ptie bench --only kernel
  ! ptie: bench: unknown group 'kernel' (did you mean 'kernels'?)
  [2]
  $ ptie bench --only peak,
  ! ptie: bench: unknown group '' (did you mean 'run'?)
  [2]
  $ ptie bench --time 1
  ! ptie: bench: --time: expected a time such as * (glob)
  [2]
  $ ptie bench --time 0s
  ! ptie: seconds is out of range (expected 0.0001..3600, found 0)
  [2]
  $ ptie bench peak
  ! ptie: bench: too many arguments (expected at most 0, found 'peak')
  [2]
