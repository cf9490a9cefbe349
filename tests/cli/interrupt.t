# Ctrl-C: exit code 130, no half file.

A data set is given up
  $ timeout --foreground -s INT --preserve-status 2 ptie dataset -n 1000000 -o d.h5
  ! ptie: interrupted
  [130]
  $ ls

A simulation is given up
  $ timeout --foreground -s INT --preserve-status 2 ptie simulate jet -n 1000000 -o jet.h5
  ! ptie: interrupted
  [130]
  $ ls

A training keeps what --resume needs
  $ timeout --foreground -s INT --preserve-status 5 \
  >   ptie train -p $TESTS/small.ini -n 1000 -e 100000 --patience 0 --widths 2,2 -o m.safetensors
  ! unet-2-2: 261 trainable parameters
  ...
  ! m.safetensors.last holds the last step; --resume goes on from there
  ! ptie: interrupted
  [130]
  $ ls m.safetensors.last
  m.safetensors.last
  $ ls *.part
  ! ls: cannot access '*.part': No such file or directory
  [2]

SIGTERM is as good
  $ timeout --foreground --preserve-status 2 ptie dataset -n 1000000 -o d.h5
  ! ptie: interrupted
  [143]
  $ ls
