# Every help text, as users see it: examples first, at most 80 columns.

The overview
  $ ptie help
  ptie 0.1.0: from parallel-TIE recordings to quantitative, denoised phase
  
    ptie run --rig lab.ini recording.h5 --model paper.safetensors -o phase.h5
  
  Commands:
    simulate     a synthetic camera recording of a moving flow, with its truth
    dataset      pairs of clean and noisy phase for training
    train        data set or preset -> model
    evaluate     how well a model denoises data that it has not seen
    reconstruct  recording -> phase
    denoise      phase -> denoised phase
    run          recording -> phase -> denoised phase -> metrics, in one pass
    report       the result of a run as one page: maps, metrics, noise, parameters
    metrics      MGM, SBR, BNS and CNR over frames and regions
    convert      a recording as another kind of file, or a part of it
    prepare      recording -> planes, as the solver sees them or after any step
    rig          rig files: how a set-up is built
    info         what is in a file, a model, a preset, this machine
    bench        how fast all of it is on this machine
  
  'ptie help COMMAND' shows examples and options of a command.

simulate
  $ ptie help simulate
  Simulates a camera recording of a moving flow, with its truth.
  
  Examples:
    # 20 frames of a jet and the rig that goes with them
    ptie simulate jet -o jet.h5
    ptie run --rig jet.ini jet.h5 --model models/paper.safetensors -o phase.h5
  
    # a shock front in real units, seen by diffraction
    ptie simulate shock -o shock.h5 --family physical \
        --propagation angular-spectrum --boundary mirror
  
    # what a polarisation camera would have written: MRAW, with recordings of
    # no flow, of the dark and of a target, the truth and the rig beside it
    ptie simulate jet -o lab.mraw --camera examples/camera.ini --seed 2 \
        --size 512 --pixel "10 um" --defocus "20 mm" --family physical \
        --propagation angular-spectrum --boundary mirror
  
    # every flow there is, as one figure
    ptie simulate --gallery gallery.png
  
  Usage:
    ptie simulate MORPHOLOGY -o FILE [options]
    ptie simulate --gallery FILE.png [options]
  
  Options:
    -o, --output FILE         recording to write (.h5; from a mosaic also .mraw
                              and others)
        --rig-out FILE        rig file to write; if not given, beside the
                              recording (.ini)
        --gallery FILE        draw every morphology of both families instead
                              (.png or .svg)
    -n, --frames N            frames of the recording (default: 20)
        --fps RATE            frame rate (default: 25 kHz)
        --size N or WxH       frame size in pixels (default: 256x256)
        --noise SHARE         standard deviation of the camera noise, relative to
                              the mean intensity (default: 0.05)
        --camera FILE         camera file (.ini): counts instead of intensities;
                              --noise does not count then
        --reference-frames N  with --camera: frames of the no-flow recording
                              (default: 32)
        --dark-frames N       with --camera: frames of the dark recording
                              (default: 32)
        --target-frames N     with --camera: frames of the calibration target
                              (default: 32)
        --family NAME         kind of flow model (parametric, physical; default:
                              parametric)
        --amplitude ANGLE     height of the phase; 0: 1 rad for parametric flows,
                              what the model says for physical ones (default: 0)
        --seed N              which flow, and which noise (default: 0)
        --index N             which flow of the seed (default: 0)
        --wavelength LENGTH   of the light (default: 532 nm)
        --pixel LENGTH        pixel pitch at the object (default: 20 um)
        --defocus LENGTH      distance of both planes from focus (default: 10 mm)
        --propagation NAME    forward model (tie-spectral, tie-stencil,
                              angular-spectrum; default: tie-spectral)
        --boundary NAME       what lies beyond the frame (periodic, mirror;
                              default: periodic)
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  MORPHOLOGY is one of: jet, eddies, front, pockets, fan, diffusion, shock,
  combustion, plasma, random, nozzle; or mix, several of them composed.
  
  The recording holds /entry/data/plus and /entry/data/minus (intensity relative
  to its mean) and /entry/truth/phase (rad).
  
  With --camera it holds counts, in the format of FILE's ending if the camera has
  a mosaic. Beside it: FILE_reference (no flow), FILE_dark, FILE_target (dots for
  'ptie rig calibrate'), FILE_truth.h5, the rig as a lab knows it and, as
  FILE_true.ini, as a perfect calibration would find it.

dataset
  $ ptie dataset --help
  Draws pairs of clean and noisy phase from a preset.
  
  Examples:
    # the paper's data set: 20,000 pairs to train, twice 2,500 to judge
    ptie dataset --preset paper --count 25000 -o paper.h5
  
    # your own distribution: print a preset, edit it, use it
    ptie info paper > mine.ini
    ptie dataset --preset mine.ini --count 1000 -o mine.h5
  
  Usage:
    ptie dataset --preset NAME --count N -o FILE.h5 [options]
  
  Options:
    -o, --output FILE         data set to write (.h5)
    -p, --preset NAME         paper, realistic, or an INI file (default: paper)
    -n, --count N             number of pairs (default: 25000)
        --seed N              which samples of the distribution (default: 1)
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  The file holds /clean and /noisy [N, H, W] in [0, 1] and one data set per
  parameter. Sample i depends on preset, seed and i only, so the bytes do not
  depend on the number of threads. 80 % train, 10 % validation, 10 % test, in
  this order.

train
  $ ptie train -h
  Trains a denoising network.
  
  Examples:
    # the paper's network on the paper's data, drawn on the fly
    ptie train --preset paper --count 25000 -o paper.safetensors
  
    # from a file, for an hour; later go on from where it stopped
    ptie train --data paper.h5 -o paper.safetensors --time-limit 1h
    ptie train --data paper.h5 -o paper.safetensors --resume
  
    # a larger member of the family, with the curves as a figure
    ptie train --data paper.h5 -o big.safetensors --widths 16,32,64,128 \
        --figure curves.png
  
  Usage:
    ptie train (--data FILE | --preset NAME) -o MODEL [options]
  
  Options:
    -o, --output FILE         model to write (.safetensors)
    -d, --data FILE           data set file (.h5)
    -p, --preset NAME         or: draw from a preset, without a file; paper,
                              realistic, or an INI file
    -n, --count N             samples of the preset, all splits together
                              (default: 25000)
        --data-seed N         which samples of the preset (default: 1)
    -e, --epochs N            passes over the data (default: 20)
    -b, --batch N             samples per step (default: 32)
        --lr X                learning rate, before the schedule (default:
                              0.0003)
        --warmup X            linear warm-up, epochs (default: 1)
        --weight-decay X      of AdamW (default: 0.004)
        --dropout X           share dropped at the bottleneck (default: 0.1)
        --patience N          epochs without a better validation loss before
                              stopping; 0 = never stop (default: 5)
        --time-limit TIME     stop after so long, such as 30min; 0 = no limit
                              (default: 0)
        --steps N             stop after so many steps in all; 0 = no limit
                              (default: 0)
        --checkpoint-steps N  also write FILE.last every so many steps; 0 = every
                              epoch (default: 0)
    -r, --resume              go on from FILE.last
        --from MODEL          start from the weights of another model
        --widths N,N,...      channels per level, 2 to 6 levels (default:
                              8,16,32)
        --activation NAME     of the output (sigmoid, linear; default: sigmoid)
        --seed N              of weights, order and dropout (default: 0)
        --figure FILE         draw loss, PSNR and MAE over epochs
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  Written: the best model by validation loss, FILE.last (everything --resume
  needs), FILE.history.csv and FILE.history.json. The same bits for any number
  of threads. After Ctrl-C or a limit, --resume goes on as if nothing had been.

evaluate
  $ ptie help evaluate
  Scores a model on data that it has not seen: the input as it is, and what the
  model makes of it.
  
  Examples:
    # the paper's Table 2, and examples as in its Fig. 4
    ptie evaluate paper.safetensors --data paper.h5 --figure examples.png
  
    # fresh samples of the preset, that no data set file holds
    ptie evaluate paper.safetensors --preset paper --count 1000 \
        --data-seed 99 --split all
  
  Usage:
    ptie evaluate MODEL (--data FILE | --preset NAME) [options]
  
  Options:
    -d, --data FILE           data set file (.h5)
    -p, --preset NAME         or: draw from a preset, without a file; paper,
                              realistic, or an INI file
    -n, --count N             samples of the preset, all splits together
                              (default: 25000)
        --data-seed N         which samples of the preset (default: 1)
        --split NAME          part of the data (train, validation, test, all;
                              default: test)
        --figure FILE         draw samples: noisy, denoised, clean (.png or .svg)
        --samples N,N,...     samples of the split in the figure; if not given,
                              five spread over it
        --json                scores as JSON instead of a table
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  Scores are means over samples, of maps in [0, 1]: PSNR with MAX = 1, mean
  absolute error, SSIM (11x11 Gaussian), and the training loss.

reconstruct
  $ ptie help reconstruct
  Takes a recording to phase in rad, by the transport-of-intensity equation.
  
  Examples:
    ptie reconstruct --rig jet.ini jet.h5 -o phase.h5
    ptie reconstruct --rig lab.ini --plus p.tif --zero z.tif --minus m.tif \
        -o phase.h5
  
  Usage:
    ptie reconstruct --rig FILE RECORDING -o FILE.h5 [options]
    ptie reconstruct --rig FILE --plus FILE --minus FILE -o FILE.h5 [options]
  
  Options:
    -r, --rig FILE            how the set-up is built (.ini)
    -o, --output FILE         result to write (.h5)
        --plus FILE           planes in files of their own: beyond focus
        --minus FILE          before focus
        --zero FILE           in focus
        --plus2 FILE          farther beyond focus
        --minus2 FILE         farther before focus
        --reference FILE      no-flow recording, instead of the rig's
        --dark FILE           recording without light, instead of the rig's
        --mask FILE           image of what is opaque (0), instead of the rig's
        --frames a:b:step     frames a, a + step, ... below b; each may be left
                              out
        --resume              go on where an interrupted run stopped
        --truth FILE          true phase to compare with
        --jet x,y,w,h         region of the flow, pixels of the phase
        --background x,y,w,h  region without flow; if no regions are given, they
                              are proposed from the result
        --metrics FILE        metrics of every frame as a table (.csv)
        --report FILE         page to draw at the end (.html), or 'none'; run
                              draws one beside the output
        --figure FILE         draw a frame: intensity and phase (.png or .svg)
        --figure-frame N      which of the frames processed; -1 = the middle one
                              (default: -1)
        --json                summary as JSON instead of a table
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  RECORDING holds all planes (one image of a polarisation camera, or data sets
  of HDF5; the rig names them), or the flow where the rig's set is a reference.
  Files: MRAW (.mraw, .cihx), CINE, HDF5 (FILE.h5 or FILE.h5:/path/inside), TIFF,
  MAT, NPY, PNG, raw, a folder of numbered images, or a pattern with one %d.
  
  The table has mean and standard deviation over frames: MGM, mean gradient in
  the jet; SBR, mean jet / mean background; BNS, deviation of the background;
  CNR, contrast over noise; with --truth also RMSE, correlation,
  and the share of the signal kept; residual, the map sent back through the
  forward model against the planes: 0 keeps all noise, 1 is an empty map.

denoise
  $ ptie help denoise
  Denoises a recording of phase, in rad.
  
  Examples:
    ptie denoise phase.h5 --model models/paper.safetensors -o denoised.h5
  
    # hot gas has negative phase; TIFF in, TIFF out
    ptie denoise phase.tif --model m.safetensors -o denoised.tif \
        --polarity negative
  
  Usage:
    ptie denoise PHASE --model FILE -o FILE [options]
  
  Options:
    -m, --model FILE          denoising network (.safetensors)
    -o, --output FILE         recording to write (.h5, .tif, .npy, .png)
        --polarity SIGN       sign of the flow's phase; auto judges every frame
                              (negative, auto, positive; default: auto)
        --fast                half precision where available; less exact
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  Reads and writes HDF5, TIFF, NPY and PNG (a pattern with one %d for several
  frames); the ending of the output decides. Values are taken as rad.

run
  $ ptie help run
  Takes a recording to phase in rad and to denoised phase, and measures both.
  
  Examples:
    # pairs of planes in one HDF5 file; the rig says how they were taken
    ptie run --rig jet.ini jet.h5 --model models/paper.safetensors -o phase.h5
  
    # a polarisation camera: all planes in each image
    ptie run --rig lab.ini flow.mraw --model m.safetensors -o phase.h5
  
    # planes in two files
    ptie run --rig lab.ini --plus p.tif --minus m.tif --model m.safetensors \
        -o phase.h5
  
    # numbered images of a plume, with a no-flow reference named in the rig
    ptie run --rig plume.ini 'plume/flow_%02d.png' --model m.safetensors \
        -o plume.h5 --figure plume.png --metrics plume.csv
  
  Usage:
    ptie run --rig FILE RECORDING --model FILE -o FILE.h5 [options]
    ptie run --rig FILE --plus FILE --minus FILE -m FILE -o FILE.h5 [options]
  
  Options:
    -m, --model FILE          denoising network (.safetensors)
        --fast                half precision where available; less exact
    -r, --rig FILE            how the set-up is built (.ini)
    -o, --output FILE         result to write (.h5)
        --plus FILE           planes in files of their own: beyond focus
        --minus FILE          before focus
        --zero FILE           in focus
        --plus2 FILE          farther beyond focus
        --minus2 FILE         farther before focus
        --reference FILE      no-flow recording, instead of the rig's
        --dark FILE           recording without light, instead of the rig's
        --mask FILE           image of what is opaque (0), instead of the rig's
        --frames a:b:step     frames a, a + step, ... below b; each may be left
                              out
        --resume              go on where an interrupted run stopped
        --truth FILE          true phase to compare with
        --jet x,y,w,h         region of the flow, pixels of the phase
        --background x,y,w,h  region without flow; if no regions are given, they
                              are proposed from the result
        --metrics FILE        metrics of every frame as a table (.csv)
        --report FILE         page to draw at the end (.html), or 'none'; run
                              draws one beside the output
        --figure FILE         draw a frame: intensity and phase (.png or .svg)
        --figure-frame N      which of the frames processed; -1 = the middle one
                              (default: -1)
        --json                summary as JSON instead of a table
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  RECORDING holds all planes (one image of a polarisation camera, or data sets
  of HDF5; the rig names them), or the flow where the rig's set is a reference.
  Files: MRAW (.mraw, .cihx), CINE, HDF5 (FILE.h5 or FILE.h5:/path/inside), TIFF,
  MAT, NPY, PNG, raw, a folder of numbered images, or a pattern with one %d.
  
  The table has mean and standard deviation over frames: MGM, mean gradient in
  the jet; SBR, mean jet / mean background; BNS, deviation of the background;
  CNR, contrast over noise; with --truth also RMSE, correlation,
  and the share of the signal kept; residual, the map sent back through the
  forward model against the planes: 0 keeps all noise, 1 is an empty map.

metrics
  $ ptie help metrics
  Measures phase maps over frames: mean and standard deviation of MGM, SBR, BNS
  and CNR.
  
  Examples:
    # both maps of a result of 'ptie run', regions proposed from the last one
    ptie metrics phase.h5
  
    # the paper's Table 3 and Fig. 6 with regions of your own
    ptie metrics phase.h5 --jet 100,80,60,120 --background 0,0,60,60 \
        --figure metrics.png
  
    # against the truth of a simulation
    ptie metrics phase.h5 --truth jet.h5:/entry/truth/phase
  
    # any recordings of phase, side by side
    ptie metrics before.tif after.tif
  
  Usage:
    ptie metrics PHASE... [options]
  
  Options:
        --jet x,y,w,h         region of the flow, pixels
        --background x,y,w,h  region without flow; if no regions are given, they
                              are proposed from the mean of the last recording
        --truth FILE          true phase to compare with
        --figure FILE         draw the metrics over frames (.png or .svg)
        --json                as JSON, with every frame
    -f, --force               replace existing output
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  MGM  mean gradient magnitude in the jet
  SBR  mean of the jet / mean of the background; grows without bound as a network
       prints zeros in the background, so look at CNR beside it
  BNS  standard deviation in the background
  CNR  |mean jet - mean background| / sqrt(var jet + var background)
  RMSE, correlation: against the truth, means taken out
  signal kept: slope of the map on the truth; 1 = all of it, 0 = erased

convert
  $ ptie help convert
  Writes a recording as another kind of file, or a part of it.
  
  Examples:
    # what the camera wrote, for Python and MATLAB
    ptie convert shot.cihx shot.h5 --compress
  
    # phase as a stack for Fiji, with scale and frame interval
    ptie convert phase.h5 phase.tif
  
    # every second frame of the first 100, a rectangle of each
    ptie convert phase.h5 part.npy --frames 0:100:2 --roi 64,0,128,256
  
    # images with one grey scale for all
    ptie convert phase.h5 flow_%04d.png --range -1:3
  
    # a film for slides, blue below 0 and red above
    ptie convert phase.h5 flow.mp4 --colours diverging --fps 10
  
    # for MATLAB and Octave
    ptie convert phase.h5 phase.mat --frames 0:50
  
  Usage:
    ptie convert INPUT OUTPUT [options]
  
  Options:
        --frames A:B:STEP     frames to take, B not included
        --roi x,y,w,h         rectangle to take, pixels
        --range LOW:HIGH      values of black and white in images and video; if
                              not given, the extent of each image, of the whole
                              video
        --colours MAP         of video (grey, viridis, diverging; default: grey)
        --fps RATE            of video: frames per second when shown (default: 25
                              Hz)
        --compress            HDF5: shuffled and deflated
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  INPUT is anything 'ptie info' knows as a recording: MRAW (.mraw, .cihx), CINE,
  HDF5 (FILE.h5 or FILE.h5:/path/inside), TIFF, MAT, NPY, PNG, raw, a folder of
  numbered images, or a pattern with one %d. The ending of OUTPUT decides what is
  written: .h5 .tif .npy .mat .mraw .png (a pattern with one %d for several
  frames) .y4m, and .mp4 where the program ffmpeg is installed. Integers of up to
  16 bits stay integers, everything else becomes float32. Unit, pixel, frame rate
  and frame numbers go along where the kind of file has a place for them.

info
  $ ptie help info
  Tells what is in a recording, data set, model, rig file or preset; without a
  name, what this machine runs.
  
  Examples:
    ptie info                            # this machine
    ptie info models/paper.safetensors   # a model
    ptie info jet.h5:/entry/data/plus    # a recording
    ptie info shot.mraw --json           # one of a camera, for a program
    ptie info paper > mine.ini           # a preset, to edit
  
  Usage:
    ptie info [FILE | PRESET] [--json]
  
  Options:
        --json                as JSON
    -h, --help                this text

bench
  $ ptie help bench
  Measures how fast this machine is at every part: kernels, inference, training,
  generation, solving, the whole pipeline.
  
  Examples:
    # everything; about two minutes
    ptie bench
  
    # the network alone, measured longer, on one thread
    ptie bench --only inference,training --time 5s --threads 1
  
    # the kernels of another instruction set, as JSON
    ptie bench --only peak,kernels --cpu avx2 --json -
  
  Usage:
    ptie bench [options]
  
  Options:
        --only GROUP,...      measure these groups only
        --time TIME           of one measurement (default: 1 s)
        --json FILE           also write the results as JSON; - prints them
                              instead of the table
        --markdown            print the table as Markdown
    -f, --force               replace existing output
    -T, --threads N           worker threads; 0 = all processors (default: 0)
        --cpu LEVEL           auto, scalar, avx2 or avx512 (default: auto)
        --progress HOW        on stderr; auto is a bar on a terminal (auto, bar,
                              plain, json, none; default: auto)
    -h, --help                this text
  
  Groups: peak, kernels, family, inference, training, generation, solving, run.
  Median and range over the samples of a measurement. GFLOP/s count the
  operations of the direct formulas, a multiply-add as two; their share is that
  of the machine's best rate of multiply-adds on as many threads, measured after
  every sample. Nothing else should run meanwhile.

No line is longer than a terminal
  $ for c in simulate dataset train evaluate reconstruct denoise run metrics info bench; do
  >   ptie help $c
  > done | awk 'length > 79'
