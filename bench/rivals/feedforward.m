% The diagram of feedforward.st in Octave, sample by sample, with the arithmetic of the step: the same bits.
%
% usage: octave-cli feedforward.m SIGNAL OUTPUT CHUNK REPETITIONS [--without-pow]
%
% As feedforward.py.
1;

function y = feedforward(reference, with_pow)
  ts = 50e-6;
  c1 = 0.05; c2 = 0.0013; c3 = 0.7;
  started = false;
  heading = 0; previous = 0;
  momentum = 0; momentum_lost = 0;
  control = 0; control_lost = 0;
  y = zeros(size(reference));
  for k = 1:numel(reference)
    r = reference(k);
    ahead = 0; rate = 0;
    if started
      ahead = r - previous;
      rate = ahead / ts;
    end
    branching_point = heading * ahead < 0;
    if ahead != 0
      heading = sign(ahead);
    end
    previous = r;
    started = true;
    if branching_point
      p = 0;
    else
      p = momentum;
    end
    if with_pow
      slope = c1 + c2 * p ^ c3;  % (17)
    else
      slope = c1 + c2 * p;
    end
    if slope > 0
      control_rate = rate / slope;  % (15)
    else
      control_rate = 0;
    end
    if branching_point
      momentum = 0; momentum_lost = 0;
    end
    due = abs(control_rate) * ts + momentum_lost;  % (16)
    after = momentum + due;
    if abs(momentum) >= abs(due)
      momentum_lost = (momentum - after) + due;
    else
      momentum_lost = (due - after) + momentum;
    end
    momentum = after;
    due = control_rate * ts + control_lost;
    after = control + due;
    if abs(control) >= abs(due)
      control_lost = (control - after) + due;
    else
      control_lost = (due - after) + control;
    end
    control = after;
    y(k) = control;
  end
end

arguments = argv();
file = fopen(arguments{1}, "rb");
signal = fread(file, Inf, "double");
fclose(file);
chunk = str2double(arguments{3});
with_pow = !any(strcmp(arguments, "--without-pow"));
for repetition = 1:str2double(arguments{4})
  outputs = zeros(size(signal));
  begin = cputime();
  for first = 1:chunk:numel(signal)
    last = min(first + chunk - 1, numel(signal));
    outputs(first:last) = feedforward(signal(first:last), with_pow);
  end
  printf("%.9g\n", cputime() - begin);
  if repetition == 1
    file = fopen(arguments{2}, "wb");
    fwrite(file, outputs, "double");
    fclose(file);
  end
end
