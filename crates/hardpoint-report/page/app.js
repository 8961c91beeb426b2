function e(e,t={},...n){let r=document.createElement(e);for(let[e,n]of Object.entries(t))typeof n==`function`?r.addEventListener(e.slice(2),n):n!==void 0&&n!==!1&&r.setAttribute(e,n===!0?``:String(n));return r.append(...n.filter(e=>e!==void 0&&e!==!1)),r}function t(t){return t.split("`").map((t,n)=>n%2==1?e(`code`,{},t):t)}function n(e,t){let n=e.querySelector(`button:focus`);t();for(let t of e.querySelectorAll(`button`))t.name===n?.name&&t.focus()}function r(e,t={},...n){let r=document.createElementNS(`http://www.w3.org/2000/svg`,e);for(let[e,n]of Object.entries(t))r.setAttribute(e,String(n));return r.append(...n),r}function i(e){return getComputedStyle(document.documentElement).getPropertyValue(e).trim()}function a(e){matchMedia(`(prefers-color-scheme: dark)`).addEventListener(`change`,e);for(let[t,n]of[[`beforeprint`,!0],[`afterprint`,!1]])addEventListener(t,()=>{document.documentElement.classList.toggle(`printing`,n),e()})}function o(e){return i(`--hue-${e%8}`)}function s(e,t=5){if(!Number.isFinite(e))return`–`;if(e===0)return`0`;let n=Math.abs(e);return(n>=1e6||n<1e-4?e.toExponential(t-1).replace(/\.?0+e/,`e`).replace(`e+`,`e`):String(Number(e.toPrecision(t)))).replaceAll(`-`,`−`)}function c(e,t){let n=l(t);return n?`${s(e)} ${n}`:s(e)}function l(e){return e===`1`?``:e.replaceAll(`^2`,`²`).replaceAll(`^3`,`³`).replaceAll(`*`,`·`)}function u(e,t){if(t===`1`)return l(e);let[n,...r]=l(e||`1`).split(`/`),i=t.includes(`/`)?`(${l(t)})`:l(t),a=[...r.map(e=>e.replace(/^\((.*)\)$/,`$1`)),i];return`${n||`1`}/${a.length>1?`(${a.join(`·`)})`:a[0]}`}function d(e,t){let n=l(t);return n?`${e} [${n}]`:e}function f(e){let t=10**Math.floor(Math.log10(e)),n=e/t;return(n>=5?5:n>=2?2:1)*t}var p=1e-9,m=1e-5;function h(e,t=1){return Math.abs(e)<=p*t?0:e}function g(e){return Math.max(m*Math.abs(e),p)}function _(e){let t=0;for(let n of e)Math.abs(n)>Math.abs(t)&&(t=n);return t}function v(e){return Math.abs(_(e))}function y(e,t,n){if(e.length===0)return e;let r=new Float32Array(n).fill(NaN);return e.forEach((e,n)=>r[n*t]=e),r}function b(e){return Array.from(e,e=>Number.isNaN(e)?null:e)}function x(e){return Array.from(e,e=>e>0?e:null)}function S(e,t){if(e===null||t===null||!(e>0))return[.1,1];let n=Math.floor(Math.log10(e)+1e-9),r=Math.ceil(Math.log10(t)-1e-9);return[10**Math.min(n,r-1),10**r]}function C(e,t){if(e===null||t===null)return[-1,1];let n=Math.max(Math.abs(e),Math.abs(t)),r=t-e<=m*n,i=n>0?(r?.2:m)*n:2,a=(e+t)/2,o=.56*Math.max(t-e,i);return[a-o,a+o]}var w=1e-4;function T(e,t){let[n,r,i]=[v(t[1]),v(t[2]),v(e[1])];return Float32Array.from(t[0],(a,o)=>{if(Math.abs(t[1][o])<=n*w)return Math.abs(t[2][o])>r*w&&Math.abs(e[1][o])<=i*w?e[2][o]/t[2][o]:NaN;let s=e[1][o]-e[2][o]*t[1][o]/t[2][o];return Math.abs(t[1][o])<n*.25&&Math.abs(s)>i*.1?NaN:e[1][o]/t[1][o]})}function E(e,t){let n=v(t)*w;return e.map((e,r)=>Math.abs(t[r])>n?e/t[r]:NaN)}function D(e,t,n){return e.map((e,r)=>e-n[r]*t[r])}function O(e,t,n){let r=0,i=v(e)||1,a=r=>Math.abs(e[r]-t)+.001*i*Math.abs(r-n)/e.length;for(let t=1;t<e.length;t++)a(t)<a(r)&&(r=t);return r}function k(e,t){let n=Math.min(Math.floor(t),e.length-1),r=Math.min(n+1,e.length-1);return t===n?e[n]:e[n]+(e[r]-e[n])*(t-n)}function A(e,t){let n=e.length-1;if(!(t>e[0]))return 0;if(t>=e[n])return n;let r=0,i=n;for(;i-r>1;){let n=r+i>>1;e[n]<=t?r=n:i=n}return r+(t-e[r])/(e[i]-e[r])}function j(e,t){let n=h(v(e),Math.max(t,1))||Math.max(t,1);return e.map(e=>h(e,n))}var M=[`value`,`velocity`,`acceleration`];function N(e,t){let n=t(e.times).length;return{...e,times:t(e.times),bodies:e.bodies.map(e=>({...e,poses:t(e.poses),mesh:ee(e.mesh,t)})),drivers:e.drivers.map(e=>({...e,travel:t(e.travel),alone:e.alone.map(t)})),quantities:e.quantities.map((e,n)=>({index:n,name:e.name,group:e.group,units:[e.unit,e.rate_unit,e.accel_unit],curves:te(e,t),wanted:t(e.wanted)})),maps:e.maps.map(e=>({...e,quantities:e.quantities.map(e=>({...e,values:j(t(e.values),1),sensitivities:e.sensitivities.map(e=>({...e,values:j(t(e.values),1)}))}))})),sweep:e.sweep?{...e.sweep,axes:e.sweep.axes.map(e=>({...e,values:t(e.values)}))}:void 0,margin:e.margin?{curve:t(e.margin.value),note:e.margin.note}:void 0,variables:e.variables.map((e,r)=>{let i=P(()=>e.shifts.map(t));return{...e,index:r,get shifts(){return i()},sensitivities:new Map(e.sensitivities.map(e=>[e.quantity,ne(e,n,t)]))}}),designs:e.designs.map(e=>({...e,poses:e.poses.map(t),quantities:e.quantities.map(e=>e?te(e,t):void 0),margin:e.margin?t(e.margin):void 0}))}}function ee(e,t){return e&&{file:e.file,positions:t(e.positions),triangles:t(e.triangles)}}function te(e,t){return[t(e.value),t(e.rate),t(e.accel)]}function ne(e,t,n){let r=P(()=>te(e,n)),i=P(()=>re(r().map(_))),a=P(()=>re(i().map(Math.abs))),o=P(()=>e.fd?F(e.fd,t,n):void 0);return{get curves(){return r()},get extremes(){return i()},get peaks(){return a()},get differences(){return o()}}}function re([e,t,n]){return[e,t,n]}function P(e){let t;return()=>(t??={it:e()}).it}function F(e,t,n){let[r,i,a]=te(e,n).map(n=>y(n,e.stride,t));return{curves:[r,i,a],worst:e.worst,step:e.step,unit:e.step_unit}}function ie(e,t){return t===0?e.name:`${e.name} ${M[t]}`}function I(e,t,n){return`d ${ie(e,t)} / d ${n.name}`}function L(e,t,n){return u(e.units[t],n.unit)}function R(e,t,n){let r=new Map;for(let i of e.variables){let e=i.sensitivities.get(t.index);if(!e||e.curves[n].length===0)continue;let a=r.get(i.unit)??[];r.set(i.unit,a),a.push({variable:i,sensitivity:e,peak:e.peaks[n],share:0})}for(let e of r.values()){e.sort((e,t)=>t.peak-e.peak||e.variable.index-t.variable.index);let t=e[0].peak;for(let n of e)n.share=t>0?h(n.peak/t):0}return r}function z(e){let t=new Map;for(let n of e.quantities)t.set(n.group,[...t.get(n.group)??[],n]);return[...t].sort(([e],[t])=>Number(t===`measure`)-Number(e===`measure`))}function ae(e){let t=new Set(e.variables.flatMap(({sensitivities:e})=>[...e.keys()]));return z(e).map(([e,n])=>[e,n.filter(({index:e})=>t.has(e))]).filter(([,e])=>e.length>0)}function oe(e,t,n){let r=n.toLowerCase().split(/\s+/).filter(Boolean),i=e=>{let t=e.filter(({name:e})=>r.some(t=>e.toLowerCase().includes(t)));return t.length>0?t:e},a=i(t),o=i(e.variables.filter(({sensitivities:e})=>e.size>0));return{rows:[...new Set(o.map(({unit:e})=>e))].flatMap(e=>[{unit:e},...o.filter(t=>t.unit===e).map(t=>({unit:e,variable:t}))]),quantities:a}}var se=class{report;order;#e=new Map;constructor(e,t){this.report=e,this.order=t}at(e,t){return this.#t(e).get(t)}largest(e,t){let n=0;for(let[r,{extreme:i}]of this.#t(e))r.unit===t&&(n=Math.max(n,Math.abs(i)));return n}text(e,t){let n=this.at(e,t),r=I(e,this.order,t);return n?`${r}: ${n.share===0?`≈ 0`:c(n.extreme,L(e,this.order,t))}`:`${r}: not known`}#t(e){let t=this.#e.get(e);if(t)return t;let n=new Map;for(let t of R(this.report,e,this.order).values())for(let{variable:e,sensitivity:r,share:i}of t){let t=r.extremes[this.order];n.set(e,{extreme:i===0?0:t,share:Math.sign(t)*i})}return this.#e.set(e,n),n}},ce=64,le=1,ue=class{#e;constructor(){let[e,t,n]=[`--heat-low`,`--heat-none`,`--heat-high`].map(fe),r=(e,n)=>`rgb(${t.map((t,r)=>Math.round(t+(e[r]-t)*n)).join(` `)})`,i=Array.from({length:129},(e,t)=>t/ce-1);this.#e=i.map(t=>r(t<0?e:n,Math.abs(t)))}of(e){return this.#e[Math.round((Math.min(Math.max(e,-1),1)+1)*ce)]}};function de(e){return Math.abs(e)>.6}function fe(e){let t=document.createElement(`canvas`);t.width=t.height=le;let n=t.getContext(`2d`);n.fillStyle=i(e),n.fillRect(0,0,le,le);let[r,a,o]=n.getImageData(0,0,le,le).data;return[r,a,o]}var pe=20,me={least:24,most:72},he=46,ge={width:176,height:112},_e=460,ve=18,B=`12px system-ui, sans-serif`,V=`11px system-ui, sans-serif`;function H(e){return new ye(e).element}var ye=class{state;element;#e=e(`canvas`,{"aria-hidden":`true`});#t=e(`div`,{class:`extent`});#n=e(`output`,{class:`reading`,"aria-live":`polite`,"data-testid":`heat-reading`});#r=e(`span`,{class:`ends`});#i=e(`span`);#a;#o;#s;#c;#l={rows:[],quantities:[]};#u;#d;#f={width:0,height:0};#p={left:0,top:0};#m=me.least;#h;#g=0;constructor(t){this.state=t;let n=ae(t.report);this.#c=n.length>1?[...n,[`all`,n.flatMap(([,e])=>e)]]:n,this.#u=new se(t.report,t.choice.order);let r=()=>this.#v(),i=this.#c.map(([t])=>e(`option`,{value:t},t));this.#o=e(`select`,{"aria-label":`quantities shown`,onchange:r},...i),this.#s=e(`input`,{type:`search`,placeholder:`names`,"aria-label":`filter by names`,oninput:r}),this.#a=e(`div`,{class:`window`,tabindex:0,role:`application`,"aria-label":`sensitivity map: arrow keys read cells, Enter chooses`,onscroll:()=>{this.#p={left:this.#a.scrollLeft,top:this.#a.scrollTop},this.#y()},onpointermove:e=>this.#A(this.#k(e)),onpointerleave:()=>this.#A(void 0),onclick:e=>this.#M(this.#k(e)),onkeydown:e=>this.#N(e)},this.#e,this.#t),this.element=e(`section`,{class:`heat`,"data-testid":`heat`},e(`h2`,{},`Sensitivity map`,this.#i),e(`p`,{class:`lead`},`The value that is largest over time; colours compare variables of one unit within a column.`),e(`div`,{class:`bar`},n.length>1&&e(`label`,{class:`field`},e(`span`,{},`Quantities`),this.#o),e(`label`,{class:`field`},e(`span`,{},`Filter`),this.#s),e(`span`,{class:`legend`},e(`span`,{class:`ramp`}),this.#r)),this.#a,this.#n),new ResizeObserver(([{contentRect:e}])=>{this.#f={width:e.width,height:e.height},this.#v()}).observe(this.#a),t.onChoice(()=>this.#_()),a(()=>{this.#d=void 0,this.#y()}),this.#v()}#_(){let{order:e}=this.state.choice;e!==this.#u.order&&(this.#u=new se(this.state.report,e)),this.#v()}#v(){let{report:e,choice:t}=this.state,n=this.#c.find(([e])=>e===this.#o.value)?.[1]??[];this.#l=oe(e,n,this.#s.value);let{rows:r,quantities:i}=this.#l,a=(this.#f.width-ge.width)/Math.max(1,i.length);this.#m=Math.floor(Math.min(Math.max(a,me.least),me.most));let[o,s]=[ge.width+i.length*this.#m,ge.height+r.length*pe];Object.assign(this.#t.style,{width:`${o}px`,height:`${s}px`}),this.#a.style.height=`${Math.min(s+ve,_e)}px`,this.#i.textContent=t.order===0?``:` (${M[t.order]})`,this.#h&&(this.#h.row>=r.length||this.#h.column>=i.length)&&(this.#h=void 0),this.#j(),this.#y()}#y(){this.#g===0&&(this.#g=requestAnimationFrame(()=>this.#b()))}#b(){this.#g=0;let{width:e,height:t}=this.#f,n=devicePixelRatio,[r,a]=[Math.round(e*n),Math.round(t*n)];if((this.#e.width!==r||this.#e.height!==a)&&(Object.assign(this.#e,{width:r,height:a}),Object.assign(this.#e.style,{width:`${e}px`,height:`${t}px`})),r===0||a===0)return;let o=this.#e.getContext(`2d`);o.setTransform(n,0,0,n,0,0),o.clearRect(0,0,e,t),o.textBaseline=`middle`,this.#d??=new ue,this.#w(o,this.#d),this.#E(o),this.#D(o),o.fillStyle=i(`--page`),o.fillRect(0,0,ge.width,ge.height)}#x(){let{width:e,height:t}=this.#f,n=(e,t,n)=>Math.min(n,Math.ceil(e/t));return{rows:[Math.floor(this.#p.top/pe),n(this.#p.top+t-ge.height,pe,this.#l.rows.length)],columns:[Math.floor(this.#p.left/this.#m),n(this.#p.left+e-ge.width,this.#m,this.#l.quantities.length)]}}#S(e){return ge.width+e*this.#m-this.#p.left}#C(e){return ge.height+e*pe-this.#p.top}#w(e,t){let{rows:n,columns:r}=this.#x(),[a,o,c]=[i(`--ink`),i(`--heat-text`),i(`--muted`)];e.font=V,e.textAlign=`center`;for(let i=r[0];i<r[1];i++){let r=this.#l.quantities[i],l=this.#S(i);for(let i=n[0];i<n[1];i++){let{variable:n}=this.#l.rows[i];if(!n)continue;let u=this.#u.at(r,n),d=this.#C(i);u?(e.fillStyle=t.of(u.share),e.fillRect(l,d,this.#m-1,19),this.#m<he||u.share===0||(e.fillStyle=de(u.share)?o:a,e.fillText(s(u.extreme,2),l+this.#m/2,d+pe/2))):(e.fillStyle=c,e.fillText(`·`,l+this.#m/2,d+pe/2))}}this.#T(e,this.#O(),i(`--accent`)),this.#T(e,this.#h,a)}#T(e,t,n){t&&(e.strokeStyle=n,e.lineWidth=2,e.strokeRect(this.#S(t.column),this.#C(t.row),this.#m-1,19))}#E(e){let{rows:t}=this.#x();e.fillStyle=i(`--page`),e.fillRect(0,ge.height,ge.width,this.#f.height),e.textAlign=`left`;for(let n=t[0];n<t[1];n++){let{unit:t,variable:r}=this.#l.rows[n],a=this.#C(n)+pe/2,o=r?.index===this.state.choice.variable;e.font=r?B:`italic ${V}`,e.fillStyle=i(r?o?`--accent`:`--ink`:`--muted`);let s=r?r.name:`per ${l(t)||`unit`}`;e.fillText(U(e,s,ge.width-12),r?8:0,a)}}#D(e){let{columns:t}=this.#x();e.fillStyle=i(`--page`),e.fillRect(ge.width,0,this.#f.width,ge.height),e.textAlign=`left`,e.font=B;for(let n=t[0];n<t[1];n++){let t=this.#l.quantities[n];e.save(),e.translate(this.#S(n)+this.#m/2,ge.height-6),e.rotate(-Math.PI/2),e.fillStyle=i(t.index===this.state.choice.quantity?`--accent`:`--ink`),e.fillText(U(e,t.name,ge.height-12),0,0),e.restore()}}#O(){let e=this.#l.rows.findIndex(({variable:e})=>e?.index===this.state.choice.variable),t=this.#l.quantities.findIndex(({index:e})=>e===this.state.choice.quantity);return e<0||t<0?void 0:{row:e,column:t}}#k(e){let{left:t,top:n}=this.#a.getBoundingClientRect(),[r,i]=[e.clientX-t-ge.width,e.clientY-n-ge.height],a=r<0?-1:Math.floor((r+this.#p.left)/this.#m),o=i<0?-1:Math.floor((i+this.#p.top)/pe);return a<this.#l.quantities.length&&o<this.#l.rows.length?{row:o,column:a}:void 0}#A(e){let t=e&&e.column>=0&&this.#l.rows[e.row]?.variable?e:void 0;(t?.row!==this.#h?.row||t?.column!==this.#h?.column)&&(this.#h=t,this.#j(),this.#y())}#j(){let e=this.#h??this.#O(),t=e&&this.#l.quantities[e.column],n=e&&this.#l.rows[e.row]?.variable;if(!t||!n){this.#n.textContent=``,this.#r.textContent=`largest of its column, negative to positive`;return}this.#n.textContent=this.#u.text(t,n);let r=s(this.#u.largest(t,n.unit),3),i=L(t,this.#u.order,n);this.#r.textContent=`−${r} to ${r}${i?` ${i}`:``}`}#M(e){if(!e)return;let t=this.#l.rows[e.row]?.variable,n=this.#l.quantities[e.column];this.state.choose({...t&&{variable:t.index},...n&&{quantity:n.index}})}#N(e){let t={ArrowUp:[-1,0],ArrowDown:[1,0],ArrowLeft:[0,-1],ArrowRight:[0,1]}[e.key];if(e.key===`Enter`)this.#M(this.#h);else if(e.key===`Escape`)this.#A(void 0);else if(t)this.#P(t);else return;e.preventDefault(),e.stopPropagation()}#P([e,t]){let{rows:n,quantities:r}=this.#l,i=n.findIndex(({variable:e})=>e);if(i<0||r.length===0)return;let a=this.#h??this.#O();if(!a)return this.#A({row:i,column:0});let o=Math.min(Math.max(a.column+t,0),r.length-1),s=a.row+e;for(;n[s]&&!n[s].variable;)s+=e;this.#A({row:n[s]?s:a.row,column:o});let{width:c,height:l}=this.#f,u=(e,t,n,r)=>Math.min(e,Math.max(n,e+t-r));this.#a.scrollTo(u(o*this.#m,this.#m,this.#p.left,c-ge.width),u(this.#h.row*pe,pe,this.#p.top,l-ge.height))}};function U(e,t,n){if(e.measureText(t).width<=n)return t;let[r,i]=[0,t.length];for(;i-r>1;){let a=r+i>>1;e.measureText(`${t.slice(0,a)}…`).width<=n?r=a:i=a}return`${t.slice(0,r)}…`}var be={admissible:``,reassembled:`re-assembled`,cannot_follow:`cannot follow`};function W(t){let n=be[t.admissibility];return n?e(`span`,{class:`badge ${t.admissibility}`,title:t.note},n):void 0}var G=30,xe=6,Se=20;function Ce(t){let{report:r,choice:i}=t,a=e(`h2`),o=e(`tbody`),s=e(`input`,{type:`search`,placeholder:`names`,"aria-label":`filter variables`,oninput:()=>h()}),[c,l]=[e(`div`),e(`div`)],u=[],d=[0,0],f=0,p=600,m=0,h=()=>{let e=r.quantities[i.quantity];a.textContent=e?`What moves ${ie(e,i.order)}`:``;let n=s.value.toLowerCase();u=we(t).filter(({variable:e})=>e.name.toLowerCase().includes(n)),d=[0,0],g()},g=()=>{m=0;let e=Math.max(0,Math.min(Math.floor(f/G),u.length-1)-xe),r=Math.min(u.length,Math.ceil((f+p)/G)+xe);(d[0]!==e||d[1]!==r)&&(d=[e,r],c.style.height=`${e*G}px`,l.style.height=`${(u.length-r)*G}px`,n(o,()=>o.replaceChildren(...u.slice(e,r).map(e=>Te(t,e)))))},_=e(`div`,{class:`scroll`,tabindex:0,role:`region`,"aria-label":`variables by influence`,onscroll:()=>{f=_.scrollTop,m||=requestAnimationFrame(g)}},c,e(`table`,{},o),l);return new ResizeObserver(([{contentRect:e}])=>{p=e.height,g()}).observe(_),t.onChoice(h),h(),e(`section`,{class:`ranking`,"data-testid":`ranking`},a,e(`p`,{class:`lead`},`Largest magnitude over time; bars compare variables of the same unit.`),r.variables.length>Se&&e(`label`,{class:`field`},e(`span`,{},`Filter`),s),_)}function we({report:e,choice:t}){let n=e.quantities[t.quantity];if(!n)return[];let r=[...R(e,n,t.order)].flatMap(([e,r])=>r.map(({variable:r,peak:i,share:a},o)=>({variable:r,rank:o+1,peak:i,share:a,unit:L(n,t.order,{unit:e})}))),i=e.variables.filter(({admissibility:e})=>e===`cannot_follow`);return[...r,...i.map(e=>({variable:e,peak:NaN,share:0,unit:``}))]}function Te(n,{variable:r,rank:i,peak:a,share:o,unit:s}){let l=e(`button`,{type:`button`,class:`plain`,name:r.name},r.name),u=i?[e(`td`,{class:`bars`},e(`span`,{class:`share`,style:`--share: ${o}`})),e(`td`,{class:`figure`},o>0?c(a,s):`≈ 0`)]:[e(`td`,{class:`why`,colspan:2,title:r.note},...t(r.note))];return e(`tr`,{class:`${i===1||!i?`first`:``} ${r.admissibility}`,"aria-current":String(r.index===n.choice.variable),onclick:()=>n.choose({variable:r.index})},e(`td`,{class:`rank`},i?String(i):`–`),e(`th`,{scope:`row`,title:r.name},l,W(r)),...u)}var Ee=6;function De([e,t],n,r,i){let a=i=>n+(i-e)/(t-e)*(r-n),o=ke((t-e)/i),c=Math.ceil(e/o-1e-9),l=Math.floor(t/o+1e-9);return{at:a,ticks:Array.from({length:Math.max(0,l-c+1)},(e,t)=>{let n=(c+t)*o;return{value:n,text:s(n,6)}})}}function Oe([e,t],n,r){let[i,a]=[Math.log10(e),Math.log10(t)],o=e=>e>0?n+(Math.log10(e)-i)/(a-i)*(r-n):NaN,c=Array.from({length:Math.round(a-i)+1},(e,t)=>Math.round(i)+t),l=c.length<=Ee;return{at:o,ticks:c.map(e=>({value:10**e,text:l||e%2==0?s(10**e):``}))}}function ke(e){let t=10**Math.floor(Math.log10(e));return([1,2,5].find(n=>n*t>=e*(1-1e-9))??10)*t}function Ae(e,t=!1){let[n,r]=[1/0,-1/0];for(let i of e)for(let e=0;e<i.length;e++){let a=i[e];a===null||!Number.isFinite(a)||t&&a<=0||(a<n&&(n=a),a>r&&(r=a))}return n<=r?[n,r]:void 0}function je(e,t){return e==null||t==null?NaN:e<t?-1:e>t?1:e>=t?0:NaN}function Me(e,t){return e==null||t==null?NaN:t<e?-1:t>e?1:t>=e?0:NaN}function Ne(e){let t,n,r;e.length===2?(t=e===je||e===Me?e:Pe,n=e,r=e):(t=je,n=(t,n)=>je(e(t),n),r=(t,n)=>e(t)-n);function i(e,r,i=0,a=e.length){if(i<a){if(t(r,r)!==0)return a;do{let t=i+a>>>1;n(e[t],r)<0?i=t+1:a=t}while(i<a)}return i}function a(e,r,i=0,a=e.length){if(i<a){if(t(r,r)!==0)return a;do{let t=i+a>>>1;n(e[t],r)<=0?i=t+1:a=t}while(i<a)}return i}function o(e,t,n=0,a=e.length){let o=i(e,t,n,a-1);return o>n&&r(e[o-1],t)>-r(e[o],t)?o-1:o}return{left:i,center:o,right:a}}function Pe(){return 0}function Fe(e){return e===null?NaN:+e}var Ie=Ne(je);Ie.right,Ie.left,Ne(Fe).center;function Le(e,t){let n=0;if(t===void 0)for(let t of e)t!=null&&(t=+t)>=t&&++n;else{let r=-1;for(let i of e)(i=t(i,++r,e))!=null&&(i=+i)>=i&&++n}return n}function Re(e,t){let n,r;if(t===void 0)for(let t of e)t!=null&&(n===void 0?t>=t&&(n=r=t):(n>t&&(n=t),r<t&&(r=t)));else{let i=-1;for(let a of e)(a=t(a,++i,e))!=null&&(n===void 0?a>=a&&(n=r=a):(n>a&&(n=a),r<a&&(r=a)))}return[n,r]}Array.prototype.slice;var ze=Math.sqrt(50),Be=Math.sqrt(10),Ve=Math.sqrt(2);function He(e,t,n){let r=(t-e)/Math.max(0,n),i=Math.floor(Math.log10(r)),a=r/10**i,o=a>=ze?10:a>=Be?5:a>=Ve?2:1,s,c,l;return i<0?(l=10**-i/o,s=Math.round(e*l),c=Math.round(t*l),s/l<e&&++s,c/l>t&&--c,l=-l):(l=10**i*o,s=Math.round(e/l),c=Math.round(t/l),s*l<e&&++s,c*l>t&&--c),c<s&&.5<=n&&n<2?He(e,t,n*2):[s,c,l]}function Ue(e,t,n){if(t=+t,e=+e,n=+n,!(n>0))return[];if(e===t)return[e];let r=t<e,[i,a,o]=r?He(t,e,n):He(e,t,n);if(!(a>=i))return[];let s=a-i+1,c=Array(s);if(r){if(o<0)for(let e=0;e<s;++e)c[e]=(a-e)/-o;else for(let e=0;e<s;++e)c[e]=(a-e)*o}else if(o<0)for(let e=0;e<s;++e)c[e]=(i+e)/-o;else for(let e=0;e<s;++e)c[e]=(i+e)*o;return c}function We(e,t,n){return t=+t,e=+e,n=+n,He(e,t,n)[2]}function Ge(e,t,n){let r;for(;;){let i=We(e,t,n);if(i===r||i===0||!isFinite(i))return[e,t];if(i>0){let n=Math.ceil(e/i),r=Math.floor(t/i);e=(n-(n*i>e))*i,t=(r+(r*i<t))*i}else if(i<0){let n=-i,r=Math.ceil(e*n),a=Math.floor(t*n);e=(r-(r/n>e))/n,t=(a+(a/n<t))/n}r=i}}function Ke(e){return Math.max(1,Math.ceil(Math.log(Le(e))/Math.LN2)+1)}var qe=Array.prototype.slice;function Je(e,t){return e-t}function Ye(e){for(var t=0,n=e.length,r=e[n-1][1]*e[0][0]-e[n-1][0]*e[0][1];++t<n;)r+=e[t-1][1]*e[t][0]-e[t-1][0]*e[t][1];return r}var Xe=e=>()=>e;function Ze(e,t){for(var n=-1,r=t.length,i;++n<r;)if(i=Qe(e,t[n]))return i;return 0}function Qe(e,t){for(var n=t[0],r=t[1],i=-1,a=0,o=e.length,s=o-1;a<o;s=a++){var c=e[a],l=c[0],u=c[1],d=e[s],f=d[0],p=d[1];if($e(c,d,t))return 0;u>r!=p>r&&n<(f-l)*(r-u)/(p-u)+l&&(i=-i)}return i}function $e(e,t,n){var r;return et(e,t,n)&&tt(e[r=+(e[0]===t[0])],n[r],t[r])}function et(e,t,n){return(t[0]-e[0])*(n[1]-e[1])===(n[0]-e[0])*(t[1]-e[1])}function tt(e,t,n){return e<=t&&t<=n||n<=t&&t<=e}function nt(){}var rt=[[],[[[1,1.5],[.5,1]]],[[[1.5,1],[1,1.5]]],[[[1.5,1],[.5,1]]],[[[1,.5],[1.5,1]]],[[[1,1.5],[.5,1]],[[1,.5],[1.5,1]]],[[[1,.5],[1,1.5]]],[[[1,.5],[.5,1]]],[[[.5,1],[1,.5]]],[[[1,1.5],[1,.5]]],[[[.5,1],[1,.5]],[[1.5,1],[1,1.5]]],[[[1.5,1],[1,.5]]],[[[.5,1],[1.5,1]]],[[[1,1.5],[1.5,1]]],[[[.5,1],[1,1.5]]],[]];function it(){var e=1,t=1,n=Ke,r=c;function i(e){var t=n(e);if(Array.isArray(t))t=t.slice().sort(Je);else{let n=Re(e,at);for(t=Ue(...Ge(n[0],n[1],t),t);t[t.length-1]>=n[1];)t.pop();for(;t[1]<n[0];)t.shift()}return t.map(t=>a(e,t))}function a(e,t){let n=t==null?NaN:+t;if(isNaN(n))throw Error(`invalid value: ${t}`);var i=[],a=[];return o(e,n,function(t){r(t,e,n),Ye(t)>0?i.push([t]):a.push(t)}),a.forEach(function(e){for(var t=0,n=i.length,r;t<n;++t)if(Ze((r=i[t])[0],e)!==-1){r.push(e);return}}),{type:`MultiPolygon`,value:t,coordinates:i}}function o(n,r,i){var a=[],o=[],c=l=-1,l,u,d=ot(n[0],r),f,p;for(rt[d<<1].forEach(m);++c<e-1;)u=d,d=ot(n[c+1],r),rt[u|d<<1].forEach(m);for(rt[d|0].forEach(m);++l<t-1;){for(c=-1,d=ot(n[l*e+e],r),f=ot(n[l*e],r),rt[d<<1|f<<2].forEach(m);++c<e-1;)u=d,d=ot(n[l*e+e+c+1],r),p=f,f=ot(n[l*e+c+1],r),rt[u|d<<1|f<<2|p<<3].forEach(m);rt[d|f<<3].forEach(m)}for(c=-1,f=n[l*e]>=r,rt[f<<2].forEach(m);++c<e-1;)p=f,f=ot(n[l*e+c+1],r),rt[f<<2|p<<3].forEach(m);rt[f<<3].forEach(m);function m(e){var t=[e[0][0]+c,e[0][1]+l],n=[e[1][0]+c,e[1][1]+l],r=s(t),u=s(n),d,f;(d=o[r])?(f=a[u])?(delete o[d.end],delete a[f.start],d===f?(d.ring.push(n),i(d.ring)):a[d.start]=o[f.end]={start:d.start,end:f.end,ring:d.ring.concat(f.ring)}):(delete o[d.end],d.ring.push(n),o[d.end=u]=d):(d=a[u])?(f=o[r])?(delete a[d.start],delete o[f.end],d===f?(d.ring.push(n),i(d.ring)):a[f.start]=o[d.end]={start:f.start,end:d.end,ring:f.ring.concat(d.ring)}):(delete a[d.start],d.ring.unshift(t),a[d.start=r]=d):a[r]=o[u]={start:r,end:u,ring:[t,n]}}}function s(t){return t[0]*2+t[1]*(e+1)*4}function c(n,r,i){n.forEach(function(n){var a=n[0],o=n[1],s=a|0,c=o|0,l=st(r[c*e+s]);a>0&&a<e&&s===a&&(n[0]=ct(a,st(r[c*e+s-1]),l,i)),o>0&&o<t&&c===o&&(n[1]=ct(o,st(r[(c-1)*e+s]),l,i))})}return i.contour=a,i.size=function(n){if(!arguments.length)return[e,t];var r=Math.floor(n[0]),a=Math.floor(n[1]);if(!(r>=0&&a>=0))throw Error(`invalid size`);return e=r,t=a,i},i.thresholds=function(e){return arguments.length?(n=typeof e==`function`?e:Xe(Array.isArray(e)?qe.call(e):e),i):n},i.smooth=function(e){return arguments.length?(r=e?c:nt,i):r===c},i}function at(e){return isFinite(e)?e:NaN}function ot(e,t){return e!=null&&+e>=t}function st(e){return e==null||isNaN(e=+e)?-1/0:e}function ct(e,t,n,r){let i=r-t,a=n-t,o=isFinite(i)||isFinite(a)?i/a:Math.sign(i)/Math.sign(a);return isNaN(o)?e:e+o-.5}var lt=8;function ut(e){let[t,n]=Ae([e])??[0,0];if(!(n>t))return[];let r=ke((n-t)/lt),i=Math.ceil(t/r);return Array.from({length:Math.max(0,Math.floor(n/r)-i+1)},(e,t)=>(i+t)*r).filter(e=>e>t&&e<n)}function dt({columns:e,rows:t,values:n},r){let i=it().size([e.length,t.length]).smooth(!0),a=Array.from(n,e=>Number.isFinite(e)?e:NaN);return r.map(n=>({level:n,outlines:i.contour(a,n).coordinates.flat().map(n=>n.map(([n,r])=>[ft(e,n),ft(t,r)]))}))}function ft(e,t){let n=Math.min(Math.max(t-.5,0),e.length-1),r=Math.min(Math.floor(n),e.length-2);return e[r]+(e[r+1]-e[r])*(n-r)}function pt({columns:e,rows:t,values:n},r,i){let[a,o]=ht(e,r),[s,c]=ht(t,i);if(a<0||s<0)return NaN;let l=(t,r)=>n[t*e.length+r],u=e=>mt(l(e,a),l(e,a+1),o);return mt(u(s),u(s+1),c)}function mt(e,t,n){return n===0?e:n===1?t:e+(t-e)*n}function ht(e,t){let n=e.length-1;if(!(t>=e[0]&&t<=e[n]))return[-1,0];let r=e.findIndex(e=>e>t),i=r<0?n-1:r-1;return[i,(t-e[i])/(e[i+1]-e[i])]}var gt={left:62,right:96,top:10,bottom:46},_t=.62,vt=440,yt=70,bt=600;function xt(e,t){return new St(e,t).element}var St=class{map;element;#e;#t;#n=r(`svg`,{role:`img`});#r=e(`output`,{class:`reading`,"aria-live":`polite`,"data-testid":`map-reading`});#i;#a;#o=0;#s;constructor(t,n){this.map=t;let r=()=>this.#u(),i=t=>t.map((t,n)=>e(`option`,{value:n},t));this.#e=e(`select`,{"aria-label":`measure of the map`,"data-testid":`map-quantity`,onchange:()=>this.#c()},...i(t.quantities.map(({name:e})=>e))),this.#e.value=String(Math.max(0,t.quantities.findIndex(({name:e})=>e===n))),this.#t=e(`select`,{"aria-label":`its value, or its sensitivity by`,"data-testid":`map-by`,onchange:r}),this.#i=e(`div`,{class:`picture`,tabindex:0,role:`application`,"aria-label":`map ${t.name}: arrow keys read its positions`,onpointermove:e=>this.#p(e),onpointerleave:()=>this.#h(),onkeydown:e=>this.#m(e)},this.#n);let o=e(`p`,{class:`choice`},e(`label`,{},`Measure `,this.#e),e(`label`,{},`shown `,this.#t));this.element=e(`section`,{class:`driver-map`,"data-testid":`map`},e(`h3`,{},`${t.name}: over ${t.drivers[0].name} and ${t.drivers[1].name}`),o,this.#i,this.#r,e(`p`,{class:`note`},t.note)),this.#c(),a(r),new ResizeObserver(([e])=>{let t=Math.round(e.contentRect.width);t!==this.#o&&t!==0&&(this.#o=t,r())}).observe(this.#i)}#c(){let{sensitivities:t}=this.map.quantities[Number(this.#e.value)],n=[`value`,...t.map(({variable:e})=>`per ${e}`)],r=this.#t.value;this.#t.replaceChildren(...n.map((t,n)=>e(`option`,{value:n},t))),this.#t.value=Number(r)<n.length&&r?r:`0`,this.#u()}#l(){let e=this.map.quantities[Number(this.#e.value)],[t,n]=this.map.drivers.map(({places:e})=>e),r=e.sensitivities[Number(this.#t.value)-1];return r?{name:`${e.name} per ${r.variable}`,unit:r.unit,grid:{columns:t,rows:n,values:r.values}}:{name:e.name,unit:e.unit,grid:{columns:t,rows:n,values:e.values}}}#u(){if(this.#o===0)return;let{name:e,unit:t,grid:n}=this.#l(),[i,a]=[this.#o,Math.min(vt,Math.round(this.#o*_t))],[o,s]=this.map.drivers,c=e=>[e[0],e[e.length-1]],[u,f]=[i-gt.right,a-gt.bottom],p=De(c(o.places),gt.left,u,Math.max(2,(u-gt.left)/yt)),m=De(c(s.places),f,gt.top,Math.max(2,(f-gt.top)/yt));this.#a={x:p,y:m};let h=ut(n.values),g=Ct(n.values,h),_={x:gt.left,y:gt.top,width:u-gt.left,height:f-gt.top},v=e=>e.map(e=>`M${e.map(([e,t])=>`${p.at(e).toFixed(1)},${m.at(t).toFixed(1)}`).join(`L`)}Z`).join(``);this.#n.setAttribute(`viewBox`,`0 0 ${i} ${a}`),this.#n.setAttribute(`width`,String(i)),this.#n.setAttribute(`height`,String(a)),this.#n.setAttribute(`aria-label`,`${d(e,t)} over ${o.name} and ${s.name}`),this.#n.replaceChildren(r(`rect`,{..._,class:`area`,fill:g(0)}),...dt(n,h).map(({outlines:e},t)=>r(`path`,{class:`area`,d:v(e),fill:g(t+1),"fill-rule":`evenodd`})),...this.#d(n,p,m),...this.#f(n,p,m),r(`rect`,{..._,class:`frame`}),...p.ticks.map(({value:e,text:t})=>Tt(t,p.at(e),f+16,`middle`)),...m.ticks.map(({value:e,text:t})=>Tt(t,gt.left-6,m.at(e)+4,`end`)),Tt(d(o.name,o.unit),(gt.left+u)/2,a-8,`middle`),Et(d(s.name,s.unit),14,(gt.top+f)/2),...wt(h,g,l(t),u+12,_),...this.#s?[Dt(p.at(o.places[this.#s[0]]),m.at(s.places[this.#s[1]]))]:[]),this.#h()}#d({columns:e,rows:t,values:n},i,a){let o=[],s=(t,r)=>Number.isFinite(n[r*e.length+t]);for(let n=0;n+1<t.length;n++)for(let c=0;c+1<e.length;c++){if(s(c,n)&&s(c+1,n)&&s(c,n+1)&&s(c+1,n+1))continue;let[l,u,d,f]=[i.at(e[c]),i.at(e[c+1]),a.at(t[n]),a.at(t[n+1])];o.push(r(`rect`,{class:`gap`,x:l,y:f,width:u-l,height:d-f}))}return o}#f({columns:e,rows:t,values:n},i,a){return e.length*t.length>bt?[]:t.flatMap((t,r)=>e.map((i,a)=>({row:t,column:i,known:Number.isFinite(n[r*e.length+a])}))).map(({row:e,column:t,known:n})=>r(`circle`,{class:n?`place`:`place missed`,cx:i.at(t),cy:a.at(e),r:1.5}))}#p(e){if(!this.#a)return;let t=this.#n.getBoundingClientRect(),[n,r]=this.map.drivers,i=(e,t,n)=>{let[r,i]=[n[0],n[n.length-1]];return r+(t-e.at(r))/(e.at(i)-e.at(r))*(i-r)};this.#h([i(this.#a.x,e.clientX-t.left,n.places),i(this.#a.y,e.clientY-t.top,r.places)])}#m(e){let t={ArrowRight:[1,0],ArrowLeft:[-1,0],ArrowUp:[0,1],ArrowDown:[0,-1]}[e.key];if(!t)return;e.preventDefault(),e.stopPropagation();let[n,r]=this.map.drivers,[i,a]=this.#s??[Math.floor(n.places.length/2)-t[0],Math.floor(r.places.length/2)-t[1]],o=(e,t)=>Math.min(Math.max(e,0),t-1);this.#s=[o(i+t[0],n.places.length),o(a+t[1],r.places.length)],this.#u(),this.#h([n.places[this.#s[0]],r.places[this.#s[1]]])}#h(e){let{name:t,unit:n,grid:r}=this.#l(),[i,a]=this.map.drivers,o=e?pt(r,...e):NaN,l=e&&e[0]>=i.places[0]&&e[0]<=i.places.at(-1)&&e[1]>=a.places[0]&&e[1]<=a.places.at(-1),u=Ae([r.values]);this.#r.textContent=l?`${t}: ${Number.isFinite(o)?c(o,n):`not reached`} at ${i.name} ${c(e[0],i.unit)}, ${a.name} ${c(e[1],a.unit)}`:u?`${t}: ${s(u[0])} to ${c(u[1],n)}`:`${t}: no number anywhere`}};function Ct(e,t){let n=new ue,[r,i]=Ae([e])??[0,0],a=Math.max(Math.abs(r),Math.abs(i))||1,o=[r,...t,i];return e=>{let t=(o[e]+o[e+1])/2;return n.of(r<0&&i>0?t/a:i>r?(t-r)/(i-r):0)}}function wt(e,t,n,i,a){let o=a.height/(e.length+1),c=e=>a.y+a.height-(e+1)*o;return[...Array.from({length:e.length+1},(e,n)=>r(`rect`,{class:`band`,x:i,y:c(n),width:14,height:o,fill:t(n)})),...e.map((t,r)=>Tt(`${s(t)}${r===e.length-1&&n?` ${n}`:``}`,i+20,c(r)+4,`start`))]}function Tt(e,t,n,i){return r(`text`,{x:t,y:n,"text-anchor":i},document.createTextNode(e))}function Et(e,t,n){let r=Tt(e,t,n,`middle`);return r.setAttribute(`transform`,`rotate(-90 ${t} ${n})`),r}function Dt(e,t){return r(`circle`,{class:`pointed`,cx:e,cy:t,r:5})}function Ot(e,t){return Array.from({length:e.length},(e,t)=>t).filter(n=>Number.isFinite(e[n])&&Number.isFinite(t[n])).sort((n,r)=>e[n]-e[r]||t[n]-t[r]||n-r)}function kt(e,t,[n,r],i){let a,o=i;for(let i of e){let[e,s]=t(i),c=Math.hypot(e-n,s-r);c<o&&([a,o]=[i,c])}return a}var At={left:70,right:16,top:10,bottom:46},jt=.62,Mt=440,Nt=70,Pt=24;function Ft(e){return new It(e).element}var It=class{sweep;element;#e;#t;#n=r(`svg`,{role:`img`});#r=e(`output`,{class:`reading`,"aria-live":`polite`,"data-testid":`sweep-reading`});#i=e(`div`,{class:`bars`,"data-testid":`sweep-indices`});#a;#o;#s=[];#c=0;#l;constructor(t){this.sweep=t;let n=()=>this.#f(),r=(r,i)=>e(`select`,{"aria-label":`${r} axis`,"data-testid":`sweep-${r}`,onchange:n},...t.axes.map((t,n)=>e(`option`,{value:n,selected:n===i},t.name)));this.#e=r(`x`,this.#u()),this.#t=r(`y`,Math.max(0,t.axes.findIndex(({metric:e})=>e))),this.#a=e(`div`,{class:`picture`,tabindex:0,role:`application`,"aria-label":`${t.what}s: left and right arrow read one after the other, in the order of the x axis`,onpointermove:e=>this.#m(e),onkeydown:e=>this.#h(e)},this.#n);let i=t.axes[0]?.values.length??0,a=i<t.designs?`${s(i)} of ${s(t.designs,10)} ${t.what}s are drawn: every ${t.step}th.`:`${s(i)} ${t.what}s.`,o=e(`p`,{class:`choice`},e(`label`,{},`Up `,this.#t),e(`label`,{},`to the right `,this.#e));this.element=e(`section`,{class:`sweep`,"data-testid":`sweep`},o,this.#a,this.#r,e(`p`,{class:`note`},a),this.#i),n(),new ResizeObserver(([e])=>{let t=Math.round(e.contentRect.width);t!==this.#c&&t!==0&&(this.#c=t,n())}).observe(this.#a)}#u(){let e=this.sweep.axes.findIndex(({metric:e})=>e),t=this.sweep.indices.filter(({metric:t})=>t===e);return t.reduce((e,t)=>t.total[0]>e.total[0]?t:e,t[0])?.variable??0}#d(){return{x:this.sweep.axes[Number(this.#e.value)],y:this.sweep.axes[Number(this.#t.value)]}}#f(){if(this.#g(),this.#c===0)return;let{x:e,y:t}=this.#d(),[n,i]=[this.#c,Math.min(Mt,Math.round(this.#c*jt))],[a,o]=[n-At.right,i-At.bottom],s=De(Lt(e),At.left+6,a-6,Math.max(2,(a-At.left)/Nt)),c=De(Lt(t),o-6,At.top+6,Math.max(2,(o-At.top)/Nt));this.#o={x:s,y:c},this.#s=Ot(e.values,t.values),this.#l!==void 0&&!this.#s.includes(this.#l)&&(this.#l=void 0);let l=this.#s.map(n=>`M${s.at(e.values[n]).toFixed(1)},${c.at(t.values[n]).toFixed(1)}h0`).join(``),u={x:At.left,y:At.top,width:a-At.left,height:o-At.top};this.#n.setAttribute(`viewBox`,`0 0 ${n} ${i}`),this.#n.setAttribute(`width`,String(n)),this.#n.setAttribute(`height`,String(i)),this.#n.setAttribute(`aria-label`,`${d(t.name,t.unit)} over ${d(e.name,e.unit)}`),this.#n.replaceChildren(r(`rect`,{...u,class:`frame`}),r(`path`,{class:`points`,d:l}),...s.ticks.map(({value:e,text:t})=>Rt(t,s.at(e),o+16,`middle`)),...c.ticks.map(({value:e,text:t})=>Rt(t,At.left-6,c.at(e)+4,`end`)),Rt(d(e.name,e.unit),(At.left+a)/2,i-8,`middle`),zt(d(t.name,t.unit),14,(At.top+o)/2)),this.#p()}#p(){this.#n.querySelector(`.pointed`)?.remove();let{x:e,y:t}=this.#d();if(this.#l===void 0||!this.#o){let[n,r]=[this.#s.length,e.values.length];this.#r.textContent=n<r?`${s(r-n)} of the ${this.sweep.what}s drawn have no ${t.name}.`:``;return}let n=this.#l;this.#n.append(r(`circle`,{class:`pointed`,cx:this.#o.x.at(e.values[n]),cy:this.#o.y.at(t.values[n]),r:6}));let i=this.sweep.axes.map(({name:e,unit:t,values:r})=>`${e} ${Number.isFinite(r[n])?c(Number(r[n].toPrecision(5)),t):`no value`}`);this.#r.textContent=`${this.sweep.what} ${n*this.sweep.step}: ${i.join(`, `)}`}#m(e){if(!this.#o)return;let t=this.#n.getBoundingClientRect(),{x:n,y:r}=this.#d(),{x:i,y:a}=this.#o;this.#l=kt(this.#s,e=>[i.at(n.values[e]),a.at(r.values[e])],[e.clientX-t.left,e.clientY-t.top],Pt),this.#p()}#h(e){let t=this.#s.length-1,n=this.#l===void 0?-1:this.#s.indexOf(this.#l),r={ArrowRight:n+1,ArrowLeft:n<0?t:n-1,Home:0,End:t}[e.key];r===void 0||t<0||(e.preventDefault(),e.stopPropagation(),this.#l=this.#s[Math.min(Math.max(r,0),t)],this.#p())}#g(){let t=Number(this.#t.value),n=this.sweep.indices.filter(({metric:e})=>e===t).sort((e,t)=>t.total[0]-e.total[0]),r=Math.max(1,...n.map(({total:e})=>e[0]+e[1])),i=e=>`${(100*Math.min(Math.max(e/r,0),1)).toFixed(2)}%`,a=n.flatMap(({variable:t,first:n,total:r})=>[e(`span`,{},this.sweep.axes[t].name),e(`div`,{class:`bar`},e(`span`,{class:`first`,style:`width: ${i(n[0])}`}),e(`span`,{class:`total`,style:`width: ${i(r[0])}`}),e(`span`,{class:`error`,style:`left: ${i(r[0]-r[1])}; width: ${i(2*r[1])}`})),e(`span`,{},`${n[0].toFixed(3)} alone, ${r[0].toFixed(3)} ± ${r[1].toFixed(3)} in all`)]),o=e(`h3`,{style:`grid-column: 1 / -1`},`Sobol indices of ${this.sweep.axes[t]?.name}: parts of its variance`);this.#i.replaceChildren(...n.length>0?[o,...a]:[])}};function Lt({values:e}){let[t,n]=Ae([e])??[0,1];return t<n?[t,n]:[t-.5,t+.5]}function Rt(e,t,n,i){return r(`text`,{x:t,y:n,"text-anchor":i},document.createTextNode(e))}function zt(e,t,n){let r=Rt(e,t,n,`middle`);return r.setAttribute(`transform`,`rotate(-90 ${t} ${n})`),r}function Bt(t,n,r){let i=e(`div`,{class:`menu`,role:`menu`,"aria-label":t,"data-testid":`${n}-menu`,hidden:!0}),a=e(`p`,{class:`failure`,role:`alert`,hidden:!0}),o=e(`button`,{type:`button`,"aria-haspopup":`menu`,"aria-expanded":`false`,"data-testid":n,onclick:()=>i.hidden?c():l()},`${t} ▾`),s=e(`div`,{class:`dropdown`},o,i,a),c=()=>{a.hidden=!0,i.replaceChildren(...r().map(t=>e(`button`,{type:`button`,role:`menuitem`,tabindex:-1,"data-testid":t.testId,onclick:()=>u(t)},t.name))),i.hidden=!1,o.setAttribute(`aria-expanded`,`true`),i.firstElementChild?.focus()},l=()=>{i.hidden=!0,o.setAttribute(`aria-expanded`,`false`)},u=async({name:e,run:t})=>{l(),o.focus();try{await t()}catch(t){a.textContent=`${e}: ${t instanceof Error?t.message:String(t)}`,a.hidden=!1}};return s.addEventListener(`keydown`,e=>{let t=[...i.children],n=t.indexOf(document.activeElement),r={ArrowDown:n+1,ArrowUp:n-1,Home:0,End:-1}[e.key];if(!i.hidden){if(e.key===`Escape`)l(),o.focus();else if(r!==void 0)t.at(r%t.length)?.focus();else return;e.preventDefault()}}),s.addEventListener(`focusout`,e=>{s.contains(e.relatedTarget)||l()}),s}function Vt(t,{find:n,exports:r,help:i}){let{title:a,file:o}=t.report;return e(`header`,{class:`topbar`},e(`h1`,{"data-testid":`title`,title:a},a),e(`span`,{class:`file muted`},o),e(`span`,{class:`space`}),n,Ut(t),Bt(`Export`,`export`,r),e(`button`,{type:`button`,class:`help-button`,"aria-label":`keys and lines`,title:`Keys and lines (?)`,"data-testid":`help`,onclick:i},`?`))}function Ht({kind:e}){return e===`band`}function Ut(t){let{designs:n}=t.report;if(n.every(Ht))return;let r=e(`select`,{"data-testid":`compare`,onchange:()=>t.choose({compared:r.value===``?void 0:Number(r.value)})},e(`option`,{value:``},`as loaded`),...n.flatMap((t,n)=>Ht(t)?[]:[e(`option`,{value:n},t.name)]));return e(`label`,{class:`compare`},e(`span`,{class:`muted`},`Compare with`),r)}function Wt(e,t,n){for(let r of[`pointerenter`,`focusin`])t.addEventListener(r,()=>e.point(n()));for(let n of[`pointerleave`,`focusout`])t.addEventListener(n,()=>e.point())}var Gt=4;function Kt(t){let n=t.report.values.map((e,n)=>qt(t,e,n)),r=()=>{for(let{show:e}of n)e()};return t.onChoice(r),r(),e(`section`,{class:`values`,"aria-label":`Values`,"data-testid":`values`,tabindex:-1},...n.map(({element:e})=>e))}function qt(t,n,r){let i=l(n.unit),a=e(`span`,{class:`figure-now`,"data-testid":`card-value`}),o=e(`span`,{class:`delta`,"data-testid":`card-change`}),c=e(`span`,{class:`target`,"data-testid":`card-target`,"aria-hidden":`true`}),u=e(`span`,{class:`hidden`}),d=e(`button`,{type:`button`,class:`card`,"data-testid":`card-${n.name}`,title:`${n.name}, ${n.what}`,onclick:()=>Jt(t,n)},e(`span`,{class:`card-name`},e(`b`,{},n.name),` ${n.what}`),e(`span`,{class:`card-figures`},a,e(`span`,{class:`unit`},i),o),n.target?c:void 0,u);return Wt(t,d,()=>n.quantity??void 0),{element:d,show:()=>{let e=t.value(r),i=t.former?t.former.values[r]??null:n.value;a.textContent=e===null?`–`:s(h(e),Gt);let l=e===null||i===null?null:e-i,f=t.compares&&l!==null;o.hidden=!f,o.className=`delta`,f&&Yt(o,e,l,n.target),d.setAttribute(`aria-pressed`,String(n.quantity!==null&&n.quantity===t.choice.quantity)),n.target&&(u.textContent=Zt(c,n.target,e))}}}function Jt(e,{quantity:t,time:n}){t!==null&&e.choose({quantity:t,order:0}),n!==null&&(e.pause(),e.goToTime(n))}function Yt(e,t,n,r){if(Math.abs(n)<=g(t)){e.textContent=`±0`;return}let i=r?Xt(t-n,r)-Xt(t,r):0,a=i>0?`better`:i<0?`worse`:``;e.textContent=`${n>0?`+`:``}${s(n,3)}${a?` ${a}`:``}`,a&&e.classList.add(a)}function Xt(e,[t,n]){return Math.max(0,(t??-1/0)-e,e-(n??1/0))}function Zt(e,t,n){let[r,i]=t,a=[r,i,n].filter(e=>e!==null),[o,c]=[Math.min(...a),Math.max(...a)],l=(c-o||Math.abs(c)||1)*.35,u=e=>`${100*(e-o+l)/(c-o+2*l)}%`;e.style.setProperty(`--from`,r===null?`0%`:u(r)),e.style.setProperty(`--to`,i===null?`100%`:u(i)),e.style.setProperty(`--tick`,n===null?`-10%`:u(n));let d=r===null?`at most ${s(i??NaN)}`:i===null?`at least ${s(r)}`:`${s(r)} to ${s(i)}`;e.title=`wanted: ${d}`;let f=n!==null&&Xt(n,t)>0;return e.classList.toggle(`missed`,f),n===null?``:`${f?`misses`:`meets`} the target, ${d}`}var Qt=!0,$t=`uplot`,en=`u-hz`,tn=`u-vt`,nn=`u-title`,rn=`u-wrap`,an=`u-under`,on=`u-over`,sn=`u-axis`,cn=`u-off`,ln=`u-select`,un=`u-cursor-x`,dn=`u-cursor-y`,fn=`u-cursor-pt`,pn=`u-legend`,mn=`u-live`,hn=`u-inline`,gn=`u-series`,_n=`u-marker`,vn=`u-label`,yn=`u-value`,bn=`width`,xn=`height`,Sn=`top`,Cn=`bottom`,wn=`left`,Tn=`right`,En=`#000`,Dn=`#0000`,On=`mousemove`,kn=`mousedown`,An=`mouseup`,jn=`mouseenter`,Mn=`mouseleave`,Nn=`dblclick`,Pn=`resize`,Fn=`scroll`,In=`change`,Ln=`dppxchange`,Rn=`--`,zn=typeof window<`u`,Bn=zn?document:null,Vn=zn?window:null,Hn=zn?navigator:null,Un,Wn;function Gn(){let e=devicePixelRatio;Un!=e&&(Un=e,Wn&&or(In,Wn,Gn),Wn=matchMedia(`(min-resolution: ${Un-.001}dppx) and (max-resolution: ${Un+.001}dppx)`),ar(In,Wn,Gn),Vn.dispatchEvent(new CustomEvent(Ln)))}function Kn(e,t){if(t!=null){let n=e.classList;!n.contains(t)&&n.add(t)}}function qn(e,t){let n=e.classList;n.contains(t)&&n.remove(t)}function Jn(e,t,n){e.style[t]=n+`px`}function Yn(e,t,n,r){let i=Bn.createElement(e);return t!=null&&Kn(i,t),n?.insertBefore(i,r),i}function Xn(e,t){return Yn(`div`,e,t)}var Zn=new WeakMap;function Qn(e,t,n,r,i){let a=`translate(`+t+`px,`+n+`px)`;a!=Zn.get(e)&&(e.style.transform=a,Zn.set(e,a),t<0||n<0||t>r||n>i?Kn(e,cn):qn(e,cn))}var $n=new WeakMap;function er(e,t,n){let r=t+n;r!=$n.get(e)&&($n.set(e,r),e.style.background=t,e.style.borderColor=n)}var tr=new WeakMap;function nr(e,t,n,r){let i=t+``+n;i!=tr.get(e)&&(tr.set(e,i),e.style.height=n+`px`,e.style.width=t+`px`,e.style.marginLeft=r?-t/2+`px`:0,e.style.marginTop=r?-n/2+`px`:0)}var rr={passive:!0},ir={...rr,capture:!0};function ar(e,t,n,r){t.addEventListener(e,n,r?ir:rr)}function or(e,t,n,r){t.removeEventListener(e,n,rr)}zn&&Gn();function sr(e,t,n,r){let i;n||=0,r||=t.length-1;let a=r<=2147483647;for(;r-n>1;)i=a?n+r>>1:kr((n+r)/2),t[i]<e?n=i:r=i;return e-t[n]<=t[r]-e?n:r}function cr(e){return(t,n,r)=>{let i=-1,a=-1;for(let a=n;a<=r;a++)if(e(t[a])){i=a;break}for(let i=r;i>=n;i--)if(e(t[i])){a=i;break}return[i,a]}}var lr=e=>e!=null,ur=e=>e!=null&&e>0,dr=cr(lr),fr=cr(ur);function pr(e,t,n,r=0,i=!1){let a=i?fr:dr,o=i?ur:lr;[t,n]=a(e,t,n);let s=e[t],c=e[t];if(t>-1){if(r==1)s=e[t],c=e[n];else if(r==-1)s=e[n],c=e[t];else for(let r=t;r<=n;r++){let t=e[r];o(t)&&(t<s?s=t:t>c&&(c=t))}}return[s??Br,c??-Br]}function mr(e,t,n,r){let i=Fr(e),a=Fr(t);e==t&&(i==-1?(e*=n,t/=n):(e/=n,t*=n));let o=n==10?Ir:Lr,s=i==1?kr:jr,c=a==1?jr:kr,l=s(o(Or(e))),u=c(o(Or(t))),d=Pr(n,l),f=Pr(n,u);return n==10&&(l<0&&(d=ni(d,-l)),u<0&&(f=ni(f,-u))),r||n==2?(e=d*i,t=f*a):(e=ti(e,d),t=ei(t,f)),[e,t]}function hr(e,t,n,r){let i=mr(e,t,n,r);return e==0&&(i[0]=0),t==0&&(i[1]=0),i}var gr=.1,_r={mode:3,pad:gr},vr={pad:0,soft:null,mode:0},yr={min:vr,max:vr};function br(e,t,n,r){return pi(n)?Cr(e,t,n):(vr.pad=n,vr.soft=r?0:null,vr.mode=r?3:0,Cr(e,t,yr))}function xr(e,t){return e??t}function Sr(e,t,n){for(t=xr(t,0),n=xr(n,e.length-1);t<=n;){if(e[t]!=null)return!0;t++}return!1}function Cr(e,t,n){let r=n.min,i=n.max,a=xr(r.pad,0),o=xr(i.pad,0),s=xr(r.hard,-Br),c=xr(i.hard,Br),l=xr(r.soft,Br),u=xr(i.soft,-Br),d=xr(r.mode,0),f=xr(i.mode,0),p=t-e,m=Ir(p),h=Nr(Or(e),Or(t)),g=Or(Ir(h)-m);(p<1e-24||g>10)&&(p=0,(e==0||t==0)&&(p=1e-24,d==2&&l!=Br&&(a=0),f==2&&u!=-Br&&(o=0)));let _=p||h||1e3,v=Pr(10,kr(Ir(_))),y=ni(ti(e-_*(p==0?e==0?.1:1:a),v/10),24),b=e>=l&&(d==1||d==3&&y<=l||d==2&&y>=l)?l:Br,x=Nr(s,y<b&&e>=b?b:Mr(b,y)),S=ni(ei(t+_*(p==0?t==0?.1:1:o),v/10),24),C=t<=u&&(f==1||f==3&&S>=u||f==2&&S<=u)?u:-Br,w=Mr(c,S>C&&t<=C?C:Nr(C,S));return x==w&&x==0&&(w=100),[x,w]}var wr=new Intl.NumberFormat(zn?Hn.language:`en-US`),Tr=e=>wr.format(e),Er=Math,Dr=Er.PI,Or=Er.abs,kr=Er.floor,Ar=Er.round,jr=Er.ceil,Mr=Er.min,Nr=Er.max,Pr=Er.pow,Fr=Er.sign,Ir=Er.log10,Lr=Er.log2,Rr=(e,t=1)=>Er.sinh(e)*t,zr=(e,t=1)=>Er.asinh(e/t),Br=1/0;function Vr(e){return(Ir((e^e>>31)-(e>>31))|0)+1}function Hr(e,t,n){return Mr(Nr(e,t),n)}function Ur(e){return typeof e==`function`}function Wr(e){return Ur(e)?e:()=>e}var Gr=()=>{},Kr=e=>e,qr=(e,t)=>t,Jr=e=>null,Yr=e=>!0,Xr=(e,t)=>e==t,Zr=/\.\d*?(?=9{6,}|0{6,})/gm,Qr=e=>{if(ui(e)||ri.has(e))return e;let t=`${e}`,n=t.match(Zr);if(n==null)return e;let r=n[0].length-1;if(t.indexOf(`e-`)!=-1){let[e,n]=t.split(`e`);return+`${Qr(e)}e${n}`}return ni(e,r)};function $r(e,t){return Qr(ni(Qr(e/t))*t)}function ei(e,t){return Qr(jr(Qr(e/t))*t)}function ti(e,t){return Qr(kr(Qr(e/t))*t)}function ni(e,t=0){if(ui(e))return e;let n=10**t;return Ar(e*n*(1+2**-52))/n}var ri=new Map;function ii(e){return((``+e).split(`.`)[1]||``).length}function ai(e,t,n,r){let i=[],a=r.map(ii);for(let o=t;o<n;o++){let t=Or(o),n=ni(Pr(e,o),t);for(let s=0;s<r.length;s++){let c=e==10?+`${r[s]}e${o}`:r[s]*n,l=(o>=0?0:t)+(o>=a[s]?0:a[s]),u=e==10?c:ni(c,l);i.push(u),ri.set(u,l)}}return i}var oi={},si=[],ci=[null,null],li=Array.isArray,ui=Number.isInteger,di=e=>e===void 0;function fi(e){return typeof e==`string`}function pi(e){let t=!1;if(e!=null){let n=e.constructor;t=n==null||n==Object}return t}function mi(e){return typeof e==`object`&&!!e}var hi=Object.getPrototypeOf(Uint8Array),gi=`__proto__`;function _i(e,t=pi){let n;if(li(e)){let r=e.find(e=>e!=null);if(li(r)||t(r)){n=Array(e.length);for(let r=0;r<e.length;r++)n[r]=_i(e[r],t)}else n=e.slice()}else if(e instanceof hi)n=e.slice();else if(t(e)){n={};for(let r in e)r!=gi&&(n[r]=_i(e[r],t))}else n=e;return n}function vi(e){let t=arguments;for(let n=1;n<t.length;n++){let r=t[n];for(let t in r)t!=gi&&(pi(e[t])?vi(e[t],_i(r[t])):e[t]=_i(r[t]))}return e}var yi=0,bi=1,xi=2;function Si(e,t,n){for(let r=0,i,a=-1;r<t.length;r++){let o=t[r];if(o>a){for(i=o-1;i>=0&&e[i]==null;)e[i--]=null;for(i=o+1;i<n&&e[i]==null;)e[a=i++]=null}}}function Ci(e,t){if(Ei(e)){let t=e[0].slice();for(let n=1;n<e.length;n++)t.push(...e[n].slice(1));return Di(t[0])||(t=Ti(t)),t}let n=new Set;for(let t=0;t<e.length;t++){let r=e[t][0],i=r.length;for(let e=0;e<i;e++)n.add(r[e])}let r=[Array.from(n).sort((e,t)=>e-t)],i=r[0].length,a=new Map;for(let e=0;e<i;e++)a.set(r[0][e],e);for(let n=0;n<e.length;n++){let o=e[n],s=o[0];for(let e=1;e<o.length;e++){let c=o[e],l=Array(i).fill(void 0),u=t?t[n][e]:bi,d=[];for(let e=0;e<c.length;e++){let t=c[e],n=a.get(s[e]);t===null?u!=yi&&(l[n]=t,u==xi&&d.push(n)):l[n]=t}Si(l,d,i),r.push(l)}}return r}var wi=typeof queueMicrotask>`u`?e=>Promise.resolve().then(e):queueMicrotask;function Ti(e){let t=e[0],n=t.length,r=Array(n);for(let e=0;e<r.length;e++)r[e]=e;r.sort((e,n)=>t[e]-t[n]);let i=[];for(let t=0;t<e.length;t++){let a=e[t],o=Array(n);for(let e=0;e<n;e++)o[e]=a[r[e]];i.push(o)}return i}function Ei(e){let t=e[0][0],n=t.length;for(let r=1;r<e.length;r++){let i=e[r][0];if(i.length!=n)return!1;if(i!=t){for(let e=0;e<n;e++)if(i[e]!=t[e])return!1}}return!0}function Di(e,t=100){let n=e.length;if(n<=1)return!0;let r=0,i=n-1;for(;r<=i&&e[r]==null;)r++;for(;i>=r&&e[i]==null;)i--;if(i<=r)return!0;let a=Nr(1,kr((i-r+1)/t));for(let t=e[r],n=r+a;n<=i;n+=a){let r=e[n];if(r!=null){if(r<=t)return!1;t=r}}return!0}var Oi=[`January`,`February`,`March`,`April`,`May`,`June`,`July`,`August`,`September`,`October`,`November`,`December`],ki=[`Sunday`,`Monday`,`Tuesday`,`Wednesday`,`Thursday`,`Friday`,`Saturday`];function Ai(e){return e.slice(0,3)}var ji=ki.map(Ai),Mi={MMMM:Oi,MMM:Oi.map(Ai),WWWW:ki,WWW:ji};function Ni(e){return(e<10?`0`:``)+e}function Pi(e){return(e<10?`00`:e<100?`0`:``)+e}var Fi={YYYY:e=>e.getFullYear(),YY:e=>(e.getFullYear()+``).slice(2),MMMM:(e,t)=>t.MMMM[e.getMonth()],MMM:(e,t)=>t.MMM[e.getMonth()],MM:e=>Ni(e.getMonth()+1),M:e=>e.getMonth()+1,DD:e=>Ni(e.getDate()),D:e=>e.getDate(),WWWW:(e,t)=>t.WWWW[e.getDay()],WWW:(e,t)=>t.WWW[e.getDay()],HH:e=>Ni(e.getHours()),H:e=>e.getHours(),h:e=>{let t=e.getHours();return t==0?12:t>12?t-12:t},AA:e=>e.getHours()>=12?`PM`:`AM`,aa:e=>e.getHours()>=12?`pm`:`am`,a:e=>e.getHours()>=12?`p`:`a`,mm:e=>Ni(e.getMinutes()),m:e=>e.getMinutes(),ss:e=>Ni(e.getSeconds()),s:e=>e.getSeconds(),fff:e=>Pi(e.getMilliseconds())};function Ii(e,t){t||=Mi;let n=[],r=/\{([a-z]+)\}|[^{]+/gi,i;for(;i=r.exec(e);)n.push(i[0][0]==`{`?Fi[i[1]]:i[0]);return e=>{let r=``;for(let i=0;i<n.length;i++)r+=typeof n[i]==`string`?n[i]:n[i](e,t);return r}}var Li=new Intl.DateTimeFormat().resolvedOptions().timeZone;function Ri(e,t){let n;return t==`UTC`||t==`Etc/UTC`?n=new Date(+e+e.getTimezoneOffset()*6e4):t==Li?n=e:(n=new Date(e.toLocaleString(`en-US`,{timeZone:t})),n.setMilliseconds(e.getMilliseconds())),n}var zi=e=>e%1==0,Bi=[1,2,2.5,5],Vi=ai(10,-32,0,Bi),Hi=ai(10,0,32,Bi),Ui=Hi.filter(zi),Wi=Vi.concat(Hi),Gi=`
`,Ki=`{YYYY}`,qi=Gi+Ki,Ji=`{M}/{D}`,Yi=Gi+Ji,Xi=Yi+`/{YY}`,Zi=`{aa}`,Qi=`{h}:{mm}`+Zi,$i=Gi+Qi,ea=`:{ss}`,ta=null;function na(e){let t=e*1e3,n=t*60,r=n*60,i=r*24,a=i*30,o=i*365,s=(e==1?ai(10,0,3,Bi).filter(zi):ai(10,-3,0,Bi)).concat([t,t*5,t*10,t*15,t*30,n,n*5,n*10,n*15,n*30,r,r*2,r*3,r*4,r*6,r*8,r*12,i,i*2,i*3,i*4,i*5,i*6,i*7,i*8,i*9,i*10,i*15,a,a*2,a*3,a*4,a*6,o,o*2,o*5,o*10,o*25,o*50,o*100]),c=[[o,Ki,ta,ta,ta,ta,ta,ta,1],[i*28,`{MMM}`,qi,ta,ta,ta,ta,ta,1],[i,Ji,qi,ta,ta,ta,ta,ta,1],[r,`{h}`+Zi,Xi,ta,Yi,ta,ta,ta,1],[n,Qi,Xi,ta,Yi,ta,ta,ta,1],[t,ea,Xi+` `+Qi,ta,Yi+` `+Qi,ta,$i,ta,1],[e,ea+`.{fff}`,Xi+` `+Qi,ta,Yi+` `+Qi,ta,$i,ta,1]];function l(t){return(s,c,l,u,d,f)=>{let p=[],m=d>=o,h=d>=a&&d<o,g=t(l),_=ni(g*e,3),v=fa(g.getFullYear(),m?0:g.getMonth(),h||m?1:g.getDate()),y=ni(v*e,3);if(h||m){let n=h?d/a:0,r=m?d/o:0,i=_==y?_:ni(fa(v.getFullYear()+r,v.getMonth()+n,1)*e,3),s=new Date(Ar(i/e)),c=s.getFullYear(),l=s.getMonth();for(let a=0;i<=u;a++){let o=fa(c+r*a,l+n*a,1),s=o-t(ni(o*e,3));i=ni((+o+s)*e,3),i<=u&&p.push(i)}}else{let a=d>=i?i:d,o=y+(kr(l)-kr(_))+ei(_-y,a);p.push(o);let m=t(o),h=m.getHours()+m.getMinutes()/n+m.getSeconds()/r,g=d/r,v=f/s.axes[c]._space;for(;o=ni(o+d,e==1?0:3),!(o>u);)if(g>1){let e=kr(ni(h+g,6))%24,n=t(o).getHours()-e;n>1&&(n=-1),o-=n*r,h=(h+g)%24;let i=p[p.length-1];ni((o-i)/d,3)*v>=.7&&p.push(o)}else p.push(o)}return p}}return[s,c,l]}var[ra,ia,aa]=na(1),[oa,sa,ca]=na(.001);ai(2,-53,53,[1]);function la(e,t){return e.map(e=>e.map((n,r)=>r==0||r==8||n==null?n:t(r==1||e[8]==0?n:e[1]+n)))}function ua(e,t){return(n,r,i,a,o)=>{let s=t.find(e=>o>=e[0])||t[t.length-1],c,l,u,d,f,p;return r.map(t=>{let n=e(t),r=n.getFullYear(),i=n.getMonth(),a=n.getDate(),o=n.getHours(),m=n.getMinutes(),h=n.getSeconds(),g=r!=c&&s[2]||i!=l&&s[3]||a!=u&&s[4]||o!=d&&s[5]||m!=f&&s[6]||h!=p&&s[7]||s[1];return c=r,l=i,u=a,d=o,f=m,p=h,g(n)})}}function da(e,t){let n=Ii(t);return(t,r,i,a,o)=>r.map(t=>n(e(t)))}function fa(e,t,n){return new Date(e,t,n)}function pa(e,t){return t(e)}var ma=`{YYYY}-{MM}-{DD} {h}:{mm}{aa}`;function ha(e,t){return(n,r,i,a)=>a==null?Rn:t(e(r))}function ga(e,t){let n=e.series[t];return n.width?n.stroke(e,t):n.points.width?n.points.stroke(e,t):null}function _a(e,t){return e.series[t].fill(e,t)}var va={show:!0,live:!0,isolate:!1,mount:Gr,markers:{show:!0,width:2,stroke:ga,fill:_a,dash:`solid`},idx:null,idxs:null,values:[]};function ya(e,t){let n=e.cursor.points,r=Xn(),i=n.size(e,t);Jn(r,bn,i),Jn(r,xn,i);let a=i/-2;Jn(r,`marginLeft`,a),Jn(r,`marginTop`,a);let o=n.width(e,t,i);return o&&Jn(r,`borderWidth`,o),r}function ba(e,t){let n=e.series[t].points;return n._fill||n._stroke}function xa(e,t){let n=e.series[t].points;return n._stroke||n._fill}function Sa(e,t){return e.series[t].points.size}var Ca=[0,0];function wa(e,t,n){return Ca[0]=t,Ca[1]=n,Ca}function Ta(e,t,n,r=!0){return e=>{e.button!=0||r&&e.target!=t||n(e)}}function Ea(e,t,n,r=!0){return e=>{r&&e.target!=t||n(e)}}var Da={show:!0,x:!0,y:!0,lock:!1,move:wa,points:{one:!1,show:ya,size:Sa,width:0,stroke:xa,fill:ba},bind:{mousedown:Ta,mouseup:Ta,click:Ta,dblclick:Ta,mousemove:Ea,mouseleave:Ea,mouseenter:Ea},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(e,t)=>{t.stopPropagation(),t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(e,t,n,r,i)=>r-i,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Oa={show:!0,stroke:`rgba(0,0,0,0.07)`,width:2},ka=vi({},Oa,{filter:qr}),Aa=vi({},ka,{size:10}),ja=vi({},Oa,{show:!1}),Ma=`12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"`,Na=`bold `+Ma,Pa=1.5,Fa={show:!0,scale:`x`,stroke:En,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Na,side:2,grid:ka,ticks:Aa,border:ja,font:Ma,lineGap:Pa,rotate:0},Ia=`Value`,La=`Time`,Ra={show:!0,scale:`x`,auto:!1,sorted:1,min:Br,max:-1/0,idxs:[]};function za(e,t,n,r,i){return t.map(e=>e==null?``:Tr(e))}function Ba(e,t,n,r,i,a,o){let s=[],c=ri.get(i)||0;n=o?n:ni(ei(n,i),c);for(let e=n;e<=r;e=ni(e+i,c))s.push(Object.is(e,-0)?0:e);return s}function Va(e,t,n,r,i,a,o){let s=[],c=e.scales[e.axes[t].scale].log;i=Pr(c,kr((c==10?Ir:Lr)(n))),c==10&&(i=Wi[sr(i,Wi)]);let l=n,u=i*c;c==10&&(u=Wi[sr(u,Wi)]);do s.push(l),l+=i,c==10&&!ri.has(l)&&(l=ni(l,ri.get(i))),l>=u&&(i=l,u=i*c,c==10&&(u=Wi[sr(u,Wi)]));while(l<=r);return s}function Ha(e,t,n,r,i,a,o){let s=e.scales[e.axes[t].scale].asinh,c=r>s?Va(e,t,Nr(s,n),r,i):[s],l=r>=0&&n<=0?[0]:[];return(n<-s?Va(e,t,Nr(s,-r),-n,i):[s]).reverse().map(e=>-e).concat(l,c)}var Ua=/./,Wa=/[12357]/,Ga=/[125]/,Ka=/1/,qa=(e,t,n,r)=>e.map((e,i)=>t==4&&e==0||i%r==0&&n.test(e.toExponential()[+(e<0)])?e:null);function Ja(e,t,n,r,i){let a=e.axes[n],o=a.scale,s=e.scales[o],c=e.valToPos,l=a._space,u=c(10,o),d=c(9,o)-u>=l?Ua:c(7,o)-u>=l?Wa:c(5,o)-u>=l?Ga:Ka;if(d==Ka){let e=Or(c(1,o)-u);if(e<l)return qa(t.slice().reverse(),s.distr,d,jr(l/e)).reverse()}return qa(t,s.distr,d,1)}function Ya(e,t,n,r,i){let a=e.axes[n],o=a.scale,s=a._space,c=e.valToPos,l=Or(c(1,o)-c(2,o));return l<s?qa(t.slice().reverse(),3,Ua,jr(s/l)).reverse():t}function Xa(e,t,n,r){return r==null?Rn:t==null?``:Tr(t)}var Za={show:!0,scale:`y`,stroke:En,space:30,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Na,side:3,grid:ka,ticks:Aa,border:ja,font:Ma,lineGap:Pa,rotate:0};function Qa(e,t){return ni((3+(e||1)*2)*t,3)}function $a(e,t){let{scale:n,idxs:r}=e.series[0],i=e._data[0],a=e.valToPos(i[r[0]],n,!0),o=Or(e.valToPos(i[r[1]],n,!0)-a)/(e.series[t].points.space*Un);return r[1]-r[0]<=o}var eo={scale:null,auto:!0,sorted:0,min:Br,max:-1/0},to=(e,t,n,r,i)=>i,no={show:!0,auto:!0,sorted:0,gaps:to,alpha:1,facets:[vi({},eo,{scale:`x`}),vi({},eo,{scale:`y`})]},ro={scale:`y`,auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:to,alpha:1,points:{show:$a,filter:null},values:null,min:Br,max:-1/0,idxs:[],path:null,clip:null};function io(e,t,n,r,i){return n/10}var ao={time:Qt,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},oo=vi({},ao,{time:!1,ori:1}),so={};function co(e,t){let n=so[e];return n||(n={key:e,plots:[],sub(e){n.plots.push(e)},unsub(e){n.plots=n.plots.filter(t=>t!=e)},pub(e,t,r,i,a,o,s){for(let c=0;c<n.plots.length;c++)n.plots[c]!=t&&n.plots[c].pub(e,t,r,i,a,o,s)}},e!=null&&(so[e]=n)),n}var lo=1,uo=2;function fo(e,t,n){let r=e.mode,i=e.series[t],a=r==2?e._data[t]:e._data,o=e.scales,s=e.bbox,c=a[0],l=r==2?a[1]:a[t],u=r==2?o[i.facets[0].scale]:o[e.series[0].scale],d=r==2?o[i.facets[1].scale]:o[i.scale],f=s.left,p=s.top,m=s.width,h=s.height,g=e.valToPosH,_=e.valToPosV;return u.ori==0?n(i,c,l,u,d,g,_,f,p,m,h,xo,Co,To,Do,ko):n(i,c,l,u,d,_,g,p,f,h,m,So,wo,Eo,Oo,Ao)}function po(e,t){let n=0,r=0,i=xr(e.bands,si);for(let e=0;e<i.length;e++){let a=i[e];a.series[0]==t?n=a.dir:a.series[1]==t&&(a.dir==1?r|=1:r|=2)}return[n,r==1?-1:r==2?1:r==3?2:0]}function mo(e,t,n,r,i){let a=e.mode,o=e.series[t],s=a==2?o.facets[1].scale:o.scale,c=e.scales[s];return i==-1?c.min:i==1?c.max:c.distr==3?c.dir==1?c.min:c.max:0}function ho(e,t,n,r,i,a){return fo(e,t,(e,t,o,s,c,l,u,d,f,p,m)=>{let h=e.pxRound,g=s.dir*(s.ori==0?1:-1),_=s.ori==0?Co:wo,v,y;g==1?(v=n,y=r):(v=r,y=n);let b=h(l(t[v],s,p,d)),x=h(u(o[v],c,m,f)),S=h(l(t[y],s,p,d)),C=h(u(a==1?c.max:c.min,c,m,f)),w=new Path2D(i);return _(w,S,C),_(w,b,C),_(w,b,x),w})}function go(e,t,n,r,i,a){let o=null;if(e.length>0){o=new Path2D;let s=t==0?To:Eo,c=n;for(let t=0;t<e.length;t++){let n=e[t];if(n[1]>n[0]){let e=n[0]-c;e>0&&s(o,c,r,e,r+a),c=n[1]}}let l=n+i-c;l>0&&s(o,c,r-5,l,r+a+10)}return o}function _o(e,t,n){let r=e[e.length-1];r&&r[0]==t?r[1]=n:e.push([t,n])}function vo(e,t,n,r,i,a,o){let s=[],c=e.length;for(let l=i==1?n:r;l>=n&&l<=r;l+=i)if(t[l]===null){let u=l,d=l;if(i==1)for(;++l<=r&&t[l]===null;)d=l;else for(;--l>=n&&t[l]===null;)d=l;let f=a(e[u]),p=d==u?f:a(e[d]),m=u-i;f=o<=0&&m>=0&&m<c?a(e[m]):f;let h=d+i;p=o>=0&&h>=0&&h<c?a(e[h]):p,p>=f&&s.push([f,p])}return s}function yo(e){return e==0?Kr:e==1?Ar:t=>$r(t,e)}function bo(e){let t=e==0?xo:So,n=e==0?(e,t,n,r,i,a)=>{e.arcTo(t,n,r,i,a)}:(e,t,n,r,i,a)=>{e.arcTo(n,t,i,r,a)},r=e==0?(e,t,n,r,i)=>{e.rect(t,n,r,i)}:(e,t,n,r,i)=>{e.rect(n,t,i,r)};return(e,i,a,o,s,c=0,l=0)=>{c==0&&l==0?r(e,i,a,o,s):(c=Mr(c,o/2,s/2),l=Mr(l,o/2,s/2),t(e,i+c,a),n(e,i+o,a,i+o,a+s,c),n(e,i+o,a+s,i,a+s,l),n(e,i,a+s,i,a,l),n(e,i,a,i+o,a,c),e.closePath())}}var xo=(e,t,n)=>{e.moveTo(t,n)},So=(e,t,n)=>{e.moveTo(n,t)},Co=(e,t,n)=>{e.lineTo(t,n)},wo=(e,t,n)=>{e.lineTo(n,t)},To=bo(0),Eo=bo(1),Do=(e,t,n,r,i,a)=>{e.arc(t,n,r,i,a)},Oo=(e,t,n,r,i,a)=>{e.arc(n,t,r,i,a)},ko=(e,t,n,r,i,a,o)=>{e.bezierCurveTo(t,n,r,i,a,o)},Ao=(e,t,n,r,i,a,o)=>{e.bezierCurveTo(n,t,i,r,o,a)};function jo(e){return(e,t,n,r,i)=>fo(e,t,(t,a,o,s,c,l,u,d,f,p,m)=>{let{pxRound:h,points:g}=t,_,v;s.ori==0?(_=xo,v=Do):(_=So,v=Oo);let y=ni(g.width*Un,3),b=(g.size-g.width)/2*Un,x=ni(b*2,3),S=new Path2D,C=new Path2D,{left:w,top:T,width:E,height:D}=e.bbox;To(C,w-x,T-x,E+x*2,D+x*2);let O=e=>{if(o[e]!=null){let t=h(l(a[e],s,p,d)),n=h(u(o[e],c,m,f));_(S,t+b,n),v(S,t,n,b,0,Dr*2)}};if(i)i.forEach(O);else for(let e=n;e<=r;e++)O(e);return{stroke:y>0?S:null,fill:S,clip:C,flags:3}})}function Mo(e){return(t,n,r,i,a,o)=>{r!=i&&(a!=r&&o!=r&&e(t,n,r),a!=i&&o!=i&&e(t,n,i),e(t,n,o))}}var No=Mo(Co),Po=Mo(wo);function Fo(e){let t=xr(e?.alignGaps,0);return(e,n,r,i)=>fo(e,n,(a,o,s,c,l,u,d,f,p,m,h)=>{[r,i]=dr(s,r,i);let g=a.pxRound,_=e=>g(u(e,c,m,f)),v=e=>g(d(e,l,h,p)),y,b;c.ori==0?(y=Co,b=No):(y=wo,b=Po);let x=c.dir*(c.ori==0?1:-1),S={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:lo},C=S.stroke,w=!1;if(i-r>=m*4){let t=t=>e.posToVal(t,c.key,!0),n=null,a=null,l,u,d,f=_(o[x==1?r:i]),p=_(o[r]),m=_(o[i]),h=t(x==1?p+1:m-1);for(let e=x==1?r:i;e>=r&&e<=i;e+=x){let r=o[e],i=(x==1?r<h:r>h)?f:_(r),c=s[e];i==f?c==null?c===null&&(w=!0):(u=c,n==null?(y(C,i,v(u)),l=n=a=u):u<n?n=u:u>a&&(a=u)):(n!=null&&b(C,f,v(n),v(a),v(l),v(u)),c==null?(n=a=null,c===null&&(w=!0)):(u=c,y(C,i,v(u)),n=a=l=u),f=i,h=t(f+x))}n!=null&&n!=a&&d!=f&&b(C,f,v(n),v(a),v(l),v(u))}else for(let e=x==1?r:i;e>=r&&e<=i;e+=x){let t=s[e];t===null?w=!0:t!=null&&y(C,_(o[e]),v(t))}let[T,E]=po(e,n);if(a.fill!=null||T!=0){let t=S.fill=new Path2D(C),s=v(a.fillTo(e,n,a.min,a.max,T)),c=_(o[r]),l=_(o[i]);x==-1&&([l,c]=[c,l]),y(t,l,s),y(t,c,s)}if(!a.spanGaps){let l=[];w&&l.push(...vo(o,s,r,i,x,_,t)),S.gaps=l=a.gaps(e,n,r,i,l),S.clip=go(l,c.ori,f,p,m,h)}return E!=0&&(S.band=E==2?[ho(e,n,r,i,C,-1),ho(e,n,r,i,C,1)]:ho(e,n,r,i,C,E)),S})}function Io(e){let t=xr(e.align,1),n=xr(e.ascDesc,!1),r=xr(e.alignGaps,0),i=xr(e.extend,!1);return(e,a,o,s)=>fo(e,a,(c,l,u,d,f,p,m,h,g,_,v)=>{[o,s]=dr(u,o,s);let y=c.pxRound,{left:b,width:x}=e.bbox,S=e=>y(p(e,d,_,h)),C=e=>y(m(e,f,v,g)),w=d.ori==0?Co:wo,T={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:lo},E=T.stroke,D=d.dir*(d.ori==0?1:-1),O=C(u[D==1?o:s]),k=S(l[D==1?o:s]),A=k,j=k;i&&t==-1&&(j=b,w(E,j,O)),w(E,k,O);for(let e=D==1?o:s;e>=o&&e<=s;e+=D){let n=u[e];if(n==null)continue;let r=S(l[e]),i=C(n);t==1?w(E,r,O):w(E,A,i),w(E,r,i),O=i,A=r}let M=A;i&&t==1&&(M=b+x,w(E,M,O));let[N,ee]=po(e,a);if(c.fill!=null||N!=0){let t=T.fill=new Path2D(E),n=C(c.fillTo(e,a,c.min,c.max,N));w(t,M,n),w(t,j,n)}if(!c.spanGaps){let i=[];i.push(...vo(l,u,o,s,D,S,r));let f=c.width*Un/2,p=n||t==1?f:-f,m=n||t==-1?-f:f;i.forEach(e=>{e[0]+=p,e[1]+=m}),T.gaps=i=c.gaps(e,a,o,s,i),T.clip=go(i,d.ori,h,g,_,v)}return ee!=0&&(T.band=ee==2?[ho(e,a,o,s,E,-1),ho(e,a,o,s,E,1)]:ho(e,a,o,s,E,ee)),T})}function Lo(e,t,n,r,i,a,o=Br){if(e.length>1){let s=null;for(let c=0,l=1/0;c<e.length;c++)if(t[c]!==void 0){if(s!=null){let t=Or(e[c]-e[s]);t<l&&(l=t,o=Or(n(e[c],r,i,a)-n(e[s],r,i,a)))}s=c}}return o}function Ro(e){e||=oi;let t=xr(e.size,[.6,Br,1]),n=e.align||0,r=e.gap||0,i=e.radius;i=i==null?[0,0]:typeof i==`number`?[i,0]:i;let a=Wr(i),o=1-t[0],s=xr(t[1],Br),c=xr(t[2],1),l=xr(e.disp,oi),u=xr(e.each,e=>{}),{fill:d,stroke:f}=l;return(e,t,i,p)=>fo(e,t,(m,h,g,_,v,y,b,x,S,C,w)=>{let T=m.pxRound,E=n,D=r*Un,O=s*Un,k=c*Un,A,j;_.ori==0?[A,j]=a(e,t):[j,A]=a(e,t);let M=_.dir*(_.ori==0?1:-1),N=_.ori==0?To:Eo,ee=_.ori==0?u:(e,t,n,r,i,a,o)=>{u(e,t,n,i,r,o,a)},te=xr(e.bands,si).find(e=>e.series[0]==t),ne=te==null?0:te.dir,re=m.fillTo(e,t,m.min,m.max,ne),P=T(b(re,v,w,S)),F,ie,I,L=C,R=T(m.width*Un),z=!1,ae=null,oe=null,se=null,ce=null;d!=null&&(R==0||f!=null)&&(z=!0,ae=d.values(e,t,i,p),oe=new Map,new Set(ae).forEach(e=>{e!=null&&oe.set(e,new Path2D)}),R>0&&(se=f.values(e,t,i,p),ce=new Map,new Set(se).forEach(e=>{e!=null&&ce.set(e,new Path2D)})));let{x0:le,size:ue}=l;if(le!=null&&ue!=null){E=1,h=le.values(e,t,i,p),le.unit==2&&(h=h.map(t=>e.posToVal(x+t*C,_.key,!0)));let n=ue.values(e,t,i,p);ie=ue.unit==2?n[0]*C:y(n[0],_,C,x)-y(0,_,C,x),L=Lo(h,g,y,_,C,x,L),I=L-ie+D}else L=Lo(h,g,y,_,C,x,L),I=L*o+D,ie=L-I;I<1&&(I=0),R>=ie/2&&(R=0),I<5&&(T=Kr);let de=I>0,fe=L-I-(de?R:0);ie=T(Hr(fe,k,O)),F=(E==0?ie/2:E==M?0:ie)-E*M*((E==0?D/2:0)+(de?R/2:0));let pe={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},me=z?null:new Path2D,he=null;if(te!=null)he=e.data[te.series[1]];else{let{y0:n,y1:r}=l;n!=null&&r!=null&&(g=r.values(e,t,i,p),he=n.values(e,t,i,p))}let ge=A*ie,_e=j*ie;for(let n=M==1?i:p;n>=i&&n<=p;n+=M){let r=g[n];if(r==null)continue;if(he!=null){let e=he[n]??0;if(r-e==0)continue;P=b(e,v,w,S)}let i=y(_.distr!=2||l!=null?h[n]:n,_,C,x),a=b(xr(r,re),v,w,S),o=T(i-F),s=T(Nr(a,P)),c=T(Mr(a,P)),u=s-c;if(r!=null){let i=r<0?_e:ge,a=r<0?ge:_e;z?(R>0&&se[n]!=null&&N(ce.get(se[n]),o,c+kr(R/2),ie,Nr(0,u-R),i,a),ae[n]!=null&&N(oe.get(ae[n]),o,c+kr(R/2),ie,Nr(0,u-R),i,a)):N(me,o,c+kr(R/2),ie,Nr(0,u-R),i,a),ee(e,t,n,o-R/2,c,ie+R,u)}}return R>0?pe.stroke=z?ce:me:z||(pe._fill=m.width==0?m._fill:m._stroke??m._fill,pe.width=0),pe.fill=z?oe:me,pe})}function zo(e,t){let n=xr(t?.alignGaps,0);return(t,r,i,a)=>fo(t,r,(o,s,c,l,u,d,f,p,m,h,g)=>{[i,a]=dr(c,i,a);let _=o.pxRound,v=e=>_(d(e,l,h,p)),y=e=>_(f(e,u,g,m)),b,x,S;l.ori==0?(b=xo,S=Co,x=ko):(b=So,S=wo,x=Ao);let C=l.dir*(l.ori==0?1:-1),w=v(s[C==1?i:a]),T=w,E=[],D=[];for(let e=C==1?i:a;e>=i&&e<=a;e+=C)if(c[e]!=null){let t=s[e],n=v(t);E.push(T=n),D.push(y(c[e]))}let O={stroke:e(E,D,b,S,x,_),fill:null,clip:null,band:null,gaps:null,flags:lo},k=O.stroke,[A,j]=po(t,r);if(o.fill!=null||A!=0){let e=O.fill=new Path2D(k),n=y(o.fillTo(t,r,o.min,o.max,A));S(e,T,n),S(e,w,n)}if(!o.spanGaps){let e=[];e.push(...vo(s,c,i,a,C,v,n)),O.gaps=e=o.gaps(t,r,i,a,e),O.clip=go(e,l.ori,p,m,h,g)}return j!=0&&(O.band=j==2?[ho(t,r,i,a,k,-1),ho(t,r,i,a,k,1)]:ho(t,r,i,a,k,j)),O})}function Bo(e){return zo(Vo,e)}function Vo(e,t,n,r,i,a){let o=e.length;if(o<2)return null;let s=new Path2D;if(n(s,e[0],t[0]),o==2)r(s,e[1],t[1]);else{let n=Array(o),r=Array(o-1),a=Array(o-1),c=Array(o-1);for(let n=0;n<o-1;n++)a[n]=t[n+1]-t[n],c[n]=e[n+1]-e[n],r[n]=a[n]/c[n];n[0]=r[0];for(let e=1;e<o-1;e++)r[e]===0||r[e-1]===0||r[e-1]>0!=r[e]>0?n[e]=0:(n[e]=3*(c[e-1]+c[e])/((2*c[e]+c[e-1])/r[e-1]+(c[e]+2*c[e-1])/r[e]),isFinite(n[e])||(n[e]=0));n[o-1]=r[o-2];for(let r=0;r<o-1;r++)i(s,e[r]+c[r]/3,t[r]+n[r]*c[r]/3,e[r+1]-c[r]/3,t[r+1]-n[r+1]*c[r]/3,e[r+1],t[r+1])}return s}var Ho=new Set;function Uo(){for(let e of Ho)e.syncRect(!0)}zn&&(ar(Pn,Vn,Uo),ar(Fn,Vn,Uo,!0),ar(Ln,Vn,()=>{as.pxRatio=Un}));var Wo=Fo(),Go=jo();function Ko(e,t,n,r){return(r?[e[0],e[1]].concat(e.slice(2)):[e[0]].concat(e.slice(1))).map((e,r)=>Jo(e,r,t,n))}function qo(e,t){return e.map((e,n)=>n==0?{}:vi({},t,e))}function Jo(e,t,n,r){return vi({},t==0?n:r,e)}function Yo(e,t,n){return t==null?ci:[t,n]}var Xo=Yo;function Zo(e,t,n){return t==null?ci:br(t,n,gr,!0)}function Qo(e,t,n,r){return t==null?ci:mr(t,n,e.scales[r].log,!1)}var $o=Qo;function es(e,t,n,r){return t==null?ci:hr(t,n,e.scales[r].log,!1)}var ts=es;function ns(e,t,n,r,i){let a=Nr(Vr(e),Vr(t)),o=t-e,s=sr(i/r*o,n);do{let e=n[s],t=r*e/o;if(t>=i&&a+(e<5?ri.get(e):0)<=17)return[e,t]}while(++s<n.length);return[0,0]}function rs(e){let t,n;return e=e.replace(/(\d+)px/,(e,r)=>(t=Ar((n=+r)*Un))+`px`),[e,t,n]}function is(e){e.show&&[e.font,e.labelFont].forEach(e=>{let t=ni(e[2]*Un,1);e[0]=e[0].replace(/[0-9.]+px/,t+`px`),e[1]=t})}function as(e,t,n){let r={mode:xr(e.mode,1)},i=r.mode;function a(e,t,n,r){let i=t.valToPct(e);return r+n*(t.dir==-1?1-i:i)}function o(e,t,n,r){let i=t.valToPct(e);return r+n*(t.dir==-1?i:1-i)}function s(e,t,n,r){return t.ori==0?a(e,t,n,r):o(e,t,n,r)}r.valToPosH=a,r.valToPosV=o;let c=!1;r.status=0;let l=r.root=Xn($t);if(e.id!=null&&(l.id=e.id),Kn(l,e.class),e.title){let t=Xn(nn,l);t.textContent=e.title}let u=Yn(`canvas`),d=r.ctx=u.getContext(`2d`),f=Xn(rn,l);ar(`click`,f,e=>{e.target===m&&(In!=Qt||zn!=En)&&Wn.click(r,e)},!0);let p=r.under=Xn(an,f);f.appendChild(u);let m=r.over=Xn(on,f);e=_i(e);let h=+xr(e.pxAlign,1),g=yo(h);(e.plugins||[]).forEach(t=>{t.opts&&(e=t.opts(r,e)||e)});let _=e.ms||.001,v=r.series=i==1?Ko(e.series||[],Ra,ro,!1):qo(e.series||[null],no),y=r.axes=Ko(e.axes||[],Fa,Za,!0),b=r.scales={},x=r.bands=e.bands||[];x.forEach(e=>{e.fill=Wr(e.fill||null),e.dir=xr(e.dir,-1)});let S=i==2?v[1].facets[0].scale:v[0].scale,C={axes:It,series:Tt},w=(e.drawOrder||[`axes`,`series`]).map(e=>C[e]);function T(e){let t=e.distr==3?t=>Ir(t>0?t:e.clamp(r,t,e.min,e.max,e.key)):e.distr==4?t=>zr(t,e.asinh):e.distr==100?t=>e.fwd(t):e=>e;return n=>{let r=t(n),{_min:i,_max:a}=e,o=a-i;return(r-i)/o}}function E(t){let n=b[t];if(n==null){let r=(e.scales||oi)[t]||oi;if(r.from!=null){E(r.from);let e=vi({},b[r.from],r,{key:t});e.valToPct=T(e),b[t]=e}else{n=b[t]=vi({},t==S?ao:oo,r),n.key=t;let e=n.time,a=n.range,o=li(a);if((t!=S||i==2&&!e)&&(o&&(a[0]==null||a[1]==null)&&(a={min:a[0]==null?_r:{mode:1,hard:a[0],soft:a[0]},max:a[1]==null?_r:{mode:1,hard:a[1],soft:a[1]}},o=!1),!o&&pi(a))){let e=a;a=(t,n,r)=>n==null?ci:br(n,r,e)}n.range=Wr(a||(e?Xo:t==S?n.distr==3?$o:n.distr==4?ts:Yo:n.distr==3?Qo:n.distr==4?es:Zo)),n.auto=Wr(!o&&n.auto),n.clamp=Wr(n.clamp||io),n._min=n._max=null,n.valToPct=T(n)}}}E(`x`),E(`y`),i==1&&v.forEach(e=>{E(e.scale)}),y.forEach(e=>{E(e.scale)});for(let t in e.scales)E(t);let D=b[S],O=D.distr,k,A;D.ori==0?(Kn(l,en),k=a,A=o):(Kn(l,tn),k=o,A=a);let j={};for(let e in b){let t=b[e];(t.min!=null||t.max!=null)&&(j[e]={min:t.min,max:t.max},t.min=t.max=null)}let M=e.tzDate||(e=>new Date(Ar(e/_))),N=e.fmtDate||Ii,ee=_==1?aa(M):ca(M),te=ua(M,la(_==1?ia:sa,N)),ne=ha(M,pa(ma,N)),re=[],P=r.legend=vi({},va,e.legend),F=r.cursor=vi({},Da,{drag:{y:i==2}},e.cursor),ie=P.show,I=F.show,L=P.markers;P.idxs=re,L.width=Wr(L.width),L.dash=Wr(L.dash),L.stroke=Wr(L.stroke),L.fill=Wr(L.fill);let R,z,ae,oe=[],se=[],ce,le=!1,ue={};if(P.live){let e=v[1]?v[1].values:null;le=e!=null,ce=le?e(r,1,0):{_:0};for(let e in ce)ue[e]=Rn}if(ie){if(R=Yn(`table`,pn,l),ae=Yn(`tbody`,null,R),P.mount(r,R),le){z=Yn(`thead`,null,R,ae);let e=Yn(`tr`,null,z);for(var de in Yn(`th`,null,e),ce)Yn(`th`,vn,e).textContent=de}else Kn(R,hn),P.live&&Kn(R,mn)}let fe={show:!0},pe={show:!1};function me(e,t){if(t==0&&(le||!P.live||i==2))return ci;let n=[],a=Yn(`tr`,gn,ae,ae.childNodes[t]);Kn(a,e.class),e.show||Kn(a,cn);let o=Yn(`th`,null,a);if(L.show){let e=Xn(_n,o);if(t>0){let n=L.width(r,t);n&&(e.style.border=n+`px `+L.dash(r,t)+` `+L.stroke(r,t)),e.style.background=L.fill(r,t)}}let s=Xn(vn,o);for(var c in e.label instanceof HTMLElement?s.appendChild(e.label):s.textContent=e.label,t>0&&(L.show||(s.style.color=e.width>0?L.stroke(r,t):L.fill(r,t)),ge(`click`,o,t=>{if(F._lock)return;Re(t);let n=v.indexOf(e);if((t.ctrlKey||t.metaKey)!=P.isolate){let e=v.some((e,t)=>t>0&&t!=n&&e.show);v.forEach((t,r)=>{r>0&&lr(r,e?r==n?fe:pe:fe,!0,Fi.setSeries)})}else lr(n,{show:!e.show},!0,Fi.setSeries)},!1),Ve&&ge(jn,o,t=>{F._lock||(Re(t),lr(v.indexOf(e),Tr,!0,Fi.setSeries))},!1)),ce){let e=Yn(`td`,yn,a);e.textContent=`--`,n.push(e)}return[a,n]}let he=new Map;function ge(e,t,n,i=!0){let a=he.get(t)||{},o=F.bind[e](r,t,n,i);o&&(ar(e,t,a[e]=o),he.set(t,a))}function _e(e,t,n){let r=he.get(t)||{};for(let n in r)(e==null||n==e)&&(or(n,t,r[n]),delete r[n]);e??he.delete(t)}let ve=0,B=0,V=0,H=0,ye=0,U=0,be=ye,W=U,G=V,xe=H,Se=0,Ce=0,we=0,Te=0;r.bbox={};let Ee=!1,De=!1,Oe=!1,ke=!1,Ae=!1,je=!1;function Me(e,t,n){(n||e!=r.width||t!=r.height)&&Ne(e,t),Lt(!1),Oe=!0,De=!0,Ht()}function Ne(e,t){r.width=ve=V=e,r.height=B=H=t,ye=U=0,Ie(),Le();let n=r.bbox;Se=n.left=$r(ye*Un,.5),Ce=n.top=$r(U*Un,.5),we=n.width=$r(V*Un,.5),Te=n.height=$r(H*Un,.5)}function Pe(){let e=!1,t=0;for(;!e;){t++;let n=Pt(t),i=Ft(t);e=t==3||n&&i,e||(Ne(r.width,r.height),De=!0)}}function Fe({width:e,height:t}){Me(e,t)}r.setSize=Fe;function Ie(){let e=!1,t=!1,n=!1,r=!1;y.forEach((i,a)=>{if(i.show&&i._show){let{side:a,_size:o}=i,s=a%2,c=o+(i.label==null?0:i.labelSize);c>0&&(s?(V-=c,a==3?(ye+=c,r=!0):n=!0):(H-=c,a==0?(U+=c,e=!0):t=!0))}}),Xe[0]=e,Xe[1]=n,Xe[2]=t,Xe[3]=r,V-=et[1]+et[3],ye+=et[3],H-=et[2]+et[0],U+=et[0]}function Le(){let e=ye+V,t=U+H,n=ye,r=U;function i(i,a){switch(i){case 1:return e+=a,e-a;case 2:return t+=a,t-a;case 3:return n-=a,n+a;case 0:return r-=a,r+a}}y.forEach((e,t)=>{if(e.show&&e._show){let t=e.side;e._pos=i(t,e._size),e.label!=null&&(e._lpos=i(t,e.labelSize))}})}if(F.dataIdx==null){let e=F.hover,n=e.skip=new Set(e.skip??[]);n.add(void 0);let r=e.prox=Wr(e.prox),i=e.bias??=0;F.dataIdx=(e,a,o,s)=>{if(a==0)return o;let c=o,l=r(e,a,o,s)??Br,u=l>=0&&l<Br,d=D.ori==0?V:H,f=F.left,p=t[0],m=t[a];if(n.has(m[o])){c=null;let e=null,t=null,r;if(i==0||i==-1)for(r=o;e==null&&r-->0;)n.has(m[r])||(e=r);if(i==0||i==1)for(r=o;t==null&&r++<m.length;)n.has(m[r])||(t=r);if(e!=null||t!=null){if(u){let n=e==null?-1/0:k(p[e],D,d,0),r=t==null?1/0:k(p[t],D,d,0),i=f-n,a=r-f;i<=a?i<=l&&(c=e):a<=l&&(c=t)}else c=t==null?e:e==null?t:o-e<=t-o?e:t}}else u&&Or(f-k(p[o],D,d,0))>l&&(c=null);return c}}let Re=e=>{F.event=e};F.idxs=re,F._lock=!1;let ze=F.points;ze.show=Wr(ze.show),ze.size=Wr(ze.size),ze.stroke=Wr(ze.stroke),ze.width=Wr(ze.width),ze.fill=Wr(ze.fill);let Be=r.focus=vi({},e.focus||{alpha:.3},F.focus),Ve=Be.prox>=0,He=Ve&&ze.one,Ue=[],We=[],Ge=[];function Ke(e,t){let n=ze.show(r,t);if(n instanceof HTMLElement)return Kn(n,fn),Kn(n,e.class),Qn(n,-10,-10,V,H),m.insertBefore(n,Ue[t]),n}function qe(e,t){if(i==1||t>0){let t=i==1&&b[e.scale].time,n=e.value;e.value=t?fi(n)?ha(M,pa(n,N)):n||ne:n||Xa,e.label=e.label||(t?La:Ia)}if(He||t>0){e.width=e.width==null?1:e.width,e.paths=e.paths||Wo||Jr,e.fillTo=Wr(e.fillTo||mo),e.pxAlign=+xr(e.pxAlign,h),e.pxRound=yo(e.pxAlign),e.stroke=Wr(e.stroke||null),e.fill=Wr(e.fill||null),e._stroke=e._fill=e._paths=e._focus=null;let t=Qa(Nr(1,e.width),1),n=e.points=vi({},{size:t,width:Nr(1,t*.2),stroke:e.stroke,space:t*2,paths:Go,_stroke:null,_fill:null},e.points);n.show=Wr(n.show),n.filter=Wr(n.filter),n.fill=Wr(n.fill),n.stroke=Wr(n.stroke),n.paths=Wr(n.paths),n.pxAlign=e.pxAlign}if(ie){let n=me(e,t);oe.splice(t,0,n[0]),se.splice(t,0,n[1]),P.values.push(null)}if(I){re.splice(t,0,null);let n=null;He?t==0&&(n=Ke(e,t)):t>0&&(n=Ke(e,t)),Ue.splice(t,0,n),We.splice(t,0,0),Ge.splice(t,0,0)}Ni(`addSeries`,t)}function Je(e,t){t??=v.length,e=i==1?Jo(e,t,Ra,ro):Jo(e,t,{},no),v.splice(t,0,e),qe(v[t],t)}r.addSeries=Je;function Ye(e){if(v.splice(e,1),ie){P.values.splice(e,1),se.splice(e,1);let t=oe.splice(e,1)[0];_e(null,t.firstChild),t.remove()}I&&(re.splice(e,1),Ue.splice(e,1)[0].remove(),We.splice(e,1),Ge.splice(e,1)),Ni(`delSeries`,e)}r.delSeries=Ye;let Xe=[!1,!1,!1,!1];function Ze(e,t){if(e._show=e.show,e.show){let n=e.side%2,i=b[e.scale];i??=(e.scale=n?v[1].scale:S,b[e.scale]);let a=i.time;e.size=Wr(e.size),e.space=Wr(e.space),e.rotate=Wr(e.rotate),li(e.incrs)&&e.incrs.forEach(e=>{!ri.has(e)&&ri.set(e,ii(e))}),e.incrs=Wr(e.incrs||(i.distr==2?Ui:a?_==1?ra:oa:Wi)),e.splits=Wr(e.splits||(a&&i.distr==1?ee:i.distr==3?Va:i.distr==4?Ha:Ba)),e.stroke=Wr(e.stroke),e.grid.stroke=Wr(e.grid.stroke),e.ticks.stroke=Wr(e.ticks.stroke),e.border.stroke=Wr(e.border.stroke);let o=e.values;e.values=li(o)&&!li(o[0])?Wr(o):a?li(o)?ua(M,la(o,N)):fi(o)?da(M,o):o||te:o||za,e.filter=Wr(e.filter||(i.distr>=3&&i.log==10?Ja:i.distr==3&&i.log==2?Ya:qr)),e.font=rs(e.font),e.labelFont=rs(e.labelFont),e._size=e.size(r,null,t,0),e._space=e._rotate=e._incrs=e._found=e._splits=e._values=null,e._size>0&&(Xe[t]=!0,e._el=Xn(sn,f))}}function Qe(e,t,n,r){let[i,a,o,s]=n,c=t%2,l=0;return c==0&&(s||a)&&(l=t==0&&!i||t==2&&!o?Ar(Fa.size/3):0),c==1&&(i||o)&&(l=t==1&&!a||t==3&&!s?Ar(Za.size/2):0),l}let $e=r.padding=(e.padding||[Qe,Qe,Qe,Qe]).map(e=>Wr(xr(e,Qe))),et=r._padding=$e.map((e,t)=>e(r,t,Xe,0)),tt,nt=null,rt=null,it=i==1?v[0].idxs:null,at=null,ot=!1;function st(e,n){if(t=e??[],r.data=r._data=t,i==2){tt=0;for(let e=1;e<v.length;e++)tt+=t[e][0].length}else{t.length==0&&(r.data=r._data=t=[[]]),at=t[0],tt=at.length;let e=t;if(O==2){e=t.slice();let n=e[0]=Array(tt);for(let e=0;e<tt;e++)n[e]=e}r._data=t=e}if(Lt(!0),Ni(`setData`),O==2&&(Oe=!0),n!==!1){let e=D;e.auto(r,ot)?ct():cr(S,e.min,e.max),ke||=F.left>=0,je=!0,Ht()}}r.setData=st;function ct(){ot=!0;let e,n;i==1&&(tt>0?(nt=it[0]=0,rt=it[1]=tt-1,e=t[0][nt],n=t[0][rt],O==2?(e=nt,n=rt):e==n&&(O==3?[e,n]=mr(e,e,D.log,!1):O==4?[e,n]=hr(e,e,D.log,!1):D.time?n=e+Ar(86400/_):[e,n]=br(e,n,gr,!0))):(nt=it[0]=e=null,rt=it[1]=n=null)),cr(S,e,n)}let lt,ut,dt,ft,pt,mt,ht,gt,_t,vt;function yt(e,t,n,r,i,a){e??=Dn,n??=si,r??=`butt`,i??=Dn,a??=`round`,e!=lt&&(d.strokeStyle=lt=e),i!=ut&&(d.fillStyle=ut=i),t!=dt&&(d.lineWidth=dt=t),a!=pt&&(d.lineJoin=pt=a),r!=mt&&(d.lineCap=mt=r),n!=ft&&d.setLineDash(ft=n)}function bt(e,t,n,r){t!=ut&&(d.fillStyle=ut=t),e!=ht&&(d.font=ht=e),n!=gt&&(d.textAlign=gt=n),r!=_t&&(d.textBaseline=_t=r)}function xt(e,t,n,i,a=0){if(i.length>0&&e.auto(r,ot)&&(t==null||t.min==null)){let t=xr(nt,0),r=xr(rt,i.length-1),o=n.min==null?pr(i,t,r,a,e.distr==3):[n.min,n.max];e.min=Mr(e.min,n.min=o[0]),e.max=Nr(e.max,n.max=o[1])}}let St={min:null,max:null};function Ct(){for(let e in b){let t=b[e];j[e]==null&&(t.min==null||j[S]!=null&&t.auto(r,ot))&&(j[e]=St)}for(let e in b){let t=b[e];j[e]==null&&t.from!=null&&j[t.from]!=null&&(j[e]=St)}j[S]!=null&&Lt(!0);let e={};for(let t in j){let n=j[t];if(n!=null){let a=e[t]=_i(b[t],mi);if(n.min!=null)vi(a,n);else if(t!=S||i==2){if(tt==0&&a.from==null){let e=a.range(r,null,null,t);a.min=e[0],a.max=e[1]}else a.min=Br,a.max=-1/0}}}if(tt>0){v.forEach((n,a)=>{if(i==1){let i=n.scale,o=j[i];if(o==null)return;let s=e[i];if(a==0){let e=s.range(r,s.min,s.max,i);s.min=e[0],s.max=e[1],nt=sr(s.min,t[0]),rt=sr(s.max,t[0]),rt-nt>1&&(t[0][nt]<s.min&&nt++,t[0][rt]>s.max&&rt--),n.min=at[nt],n.max=at[rt]}else n.show&&n.auto&&xt(s,o,n,t[a],n.sorted);n.idxs[0]=nt,n.idxs[1]=rt}else if(a>0&&n.show&&n.auto){let[r,i]=n.facets,o=r.scale,s=i.scale,[c,l]=t[a],u=e[o],d=e[s];u!=null&&xt(u,j[o],r,c,r.sorted),d!=null&&xt(d,j[s],i,l,i.sorted),n.min=i.min,n.max=i.max}});for(let t in e){let n=e[t],i=j[t];if(n.from==null&&(i==null||i.min==null)){let e=n.range(r,n.min==Br?null:n.min,n.max==-1/0?null:n.max,t);n.min=e[0],n.max=e[1]}}}for(let t in e){let n=e[t];if(n.from!=null){let i=e[n.from];if(i.min==null)n.min=n.max=null;else{let e=n.range(r,i.min,i.max,t);n.min=e[0],n.max=e[1]}}}let n={},a=!1;for(let t in e){let r=e[t],i=b[t];if(i.min!=r.min||i.max!=r.max){i.min=r.min,i.max=r.max;let e=i.distr;i._min=e==3?Ir(i.min):e==4?zr(i.min,i.asinh):e==100?i.fwd(i.min):i.min,i._max=e==3?Ir(i.max):e==4?zr(i.max,i.asinh):e==100?i.fwd(i.max):i.max,n[t]=a=!0}}if(a){v.forEach((e,t)=>{i==2?t>0&&n.y&&(e._paths=null):n[e.scale]&&(e._paths=null)});for(let e in n)Oe=!0,Ni(`setScale`,e);I&&F.left>=0&&(ke=je=!0)}for(let e in j)j[e]=null}function wt(e){let t=Hr(nt-1,0,tt-1),n=Hr(rt+1,0,tt-1);for(;e[t]==null&&t>0;)t--;for(;e[n]==null&&n<tt-1;)n++;return[t,n]}function Tt(){if(tt>0){let e=v.some(e=>e._focus)&&vt!=Be.alpha;e&&(d.globalAlpha=vt=Be.alpha),v.forEach((e,n)=>{if(n>0&&e.show&&(Et(n,!1),Et(n,!0),e._paths==null)){let a=vt;vt!=e.alpha&&(d.globalAlpha=vt=e.alpha);let o=i==2?[0,t[n][0].length-1]:wt(t[n]);e._paths=e.paths(r,n,o[0],o[1]),vt!=a&&(d.globalAlpha=vt=a)}}),v.forEach((e,t)=>{if(t>0&&e.show){let n=vt;vt!=e.alpha&&(d.globalAlpha=vt=e.alpha),e._paths!=null&&Dt(t,!1);{let n=e._paths==null?null:e._paths.gaps,i=e.points.show(r,t,nt,rt,n),a=e.points.filter(r,t,i,n);(i||a)&&(e.points._paths=e.points.paths(r,t,nt,rt,a),Dt(t,!0))}vt!=n&&(d.globalAlpha=vt=n),Ni(`drawSeries`,t)}}),e&&(d.globalAlpha=vt=1)}}function Et(e,t){let n=t?v[e].points:v[e];n._stroke=n.stroke(r,e),n._fill=n.fill(r,e)}function Dt(e,t){let n=t?v[e].points:v[e],{stroke:r,fill:i,clip:a,flags:o,_stroke:s=n._stroke,_fill:c=n._fill,_width:l=n.width}=n._paths;l=ni(l*Un,3);let u=null,f=l%2/2;t&&c==null&&(c=l>0?`#fff`:s);let p=n.pxAlign==1&&f>0;if(p&&d.translate(f,f),!t){let e=Se-l/2,t=Ce-l/2,n=we+l,r=Te+l;u=new Path2D,u.rect(e,t,n,r)}t?kt(s,l,n.dash,n.cap,c,r,i,o,a):Ot(e,s,l,n.dash,n.cap,c,r,i,o,u,a),p&&d.translate(-f,-f)}function Ot(e,n,i,a,o,s,c,l,u,d,f){let p=!1;u!=0&&x.forEach((m,h)=>{if(m.series[0]==e){let e=v[m.series[1]],g=t[m.series[1]],_=(e._paths||oi).band;li(_)&&(_=m.dir==1?_[0]:_[1]);let y,b=null;e.show&&_&&Sr(g,nt,rt)?(b=m.fill(r,h)||s,y=e._paths.clip):_=null,kt(n,i,a,o,b,c,l,u,d,f,y,_),p=!0}}),p||kt(n,i,a,o,s,c,l,u,d,f)}function kt(e,t,n,r,i,a,o,s,c,l,u,f){yt(e,t,n,r,i),(c||l||f)&&(d.save(),c&&d.clip(c),l&&d.clip(l)),f?(s&3)==3?(d.clip(f),u&&d.clip(u),jt(i,o),At(e,a,t)):s&uo?(jt(i,o),d.clip(f),At(e,a,t)):s&lo&&(d.save(),d.clip(f),u&&d.clip(u),jt(i,o),d.restore(),At(e,a,t)):(jt(i,o),At(e,a,t)),(c||l||f)&&d.restore()}function At(e,t,n){n>0&&(t instanceof Map?t.forEach((e,t)=>{d.strokeStyle=lt=t,d.stroke(e)}):t!=null&&e&&d.stroke(t))}function jt(e,t){t instanceof Map?t.forEach((e,t)=>{d.fillStyle=ut=t,d.fill(e)}):t!=null&&e&&d.fill(t)}function Mt(e,t,n,i){let a=y[e],o;if(i<=0)o=[0,0];else{let s=a._space=a.space(r,e,t,n,i);o=ns(t,n,a._incrs=a.incrs(r,e,t,n,i,s),i,s)}return a._found=o}function Nt(e,t,n,r,i,a,o,s,c,l){let u=o%2/2;h==1&&d.translate(u,u),yt(s,o,c,l,s),d.beginPath();let f,p,m,g,_=i+(r==0||r==3?-a:a);n==0?(p=i,g=_):(f=i,m=_);for(let r=0;r<e.length;r++)t[r]!=null&&(n==0?f=m=e[r]:p=g=e[r],d.moveTo(f,p),d.lineTo(m,g));d.stroke(),h==1&&d.translate(-u,-u)}function Pt(e){let t=!0;return y.forEach((n,i)=>{if(!n.show)return;let a=b[n.scale];if(a.min==null){n._show&&(t=!1,n._show=!1,Lt(!1));return}n._show||(t=!1,n._show=!0,Lt(!1));let o=n.side,s=o%2,{min:c,max:l}=a,[u,d]=Mt(i,c,l,s==0?V:H);if(d==0)return;let f=a.distr==2,p=n._splits=n.splits(r,i,c,l,u,d,f),m=a.distr==2?p.map(e=>at[e]):p,h=a.distr==2?at[p[1]]-at[p[0]]:u,g=n._values=n.values(r,n.filter(r,m,i,d,h),i,d,h);n._rotate=o==2?n.rotate(r,g,i,d):0;let _=n._size;n._size=jr(n.size(r,g,i,e)),_!=null&&n._size!=_&&(t=!1)}),t}function Ft(e){let t=!0;return $e.forEach((n,i)=>{let a=n(r,i,Xe,e);a!=et[i]&&(t=!1),et[i]=a}),t}function It(){for(let e=0;e<y.length;e++){let t=y[e];if(!t.show||!t._show)continue;let n=t.side,i=n%2,a,o,c=t.stroke(r,e),l=n==0||n==3?-1:1,[u,f]=t._found;if(t.label!=null){let s=t.labelGap*l,p=Ar((t._lpos+s)*Un);bt(t.labelFont[0],c,`center`,n==2?Sn:Cn),d.save(),i==1?(a=o=0,d.translate(p,Ar(Ce+Te/2)),d.rotate((n==3?-Dr:Dr)/2)):(a=Ar(Se+we/2),o=p);let m=Ur(t.label)?t.label(r,e,u,f):t.label;d.fillText(m,a,o),d.restore()}if(f==0)continue;let p=b[t.scale],m=i==0?we:Te,h=i==0?Se:Ce,_=t._splits,v=p.distr==2?_.map(e=>at[e]):_,x=p.distr==2?at[_[1]]-at[_[0]]:u,S=t.ticks,C=t.border,w=S.show?S.size:0,T=Ar(w*Un),E=Ar((t.alignTo==2?t._size-w-t.gap:t.gap)*Un),D=t._rotate*-Dr/180,O=g(t._pos*Un),k=O+(T+E)*l;o=i==0?k:0,a=i==1?k:0;let A=t.font[0];bt(A,c,t.align==1?wn:t.align==2?Tn:D>0?wn:D<0?Tn:i==0?`center`:n==3?Tn:wn,D||i==1?`middle`:n==2?Sn:Cn);let j=t.font[1]*t.lineGap,M=_.map(e=>g(s(e,p,m,h))),N=t._values;for(let e=0;e<N.length;e++){let t=N[e];if(t!=null){i==0?a=M[e]:o=M[e],t=``+t;let n=t.indexOf(`
`)==-1?[t]:t.split(/\n/gm);for(let e=0;e<n.length;e++){let t=n[e];D?(d.save(),d.translate(a,o+e*j),d.rotate(D),d.fillText(t,0,0),d.restore()):d.fillText(t,a,o+e*j)}}}S.show&&Nt(M,S.filter(r,v,e,f,x),i,n,O,T,ni(S.width*Un,3),S.stroke(r,e),S.dash,S.cap);let ee=t.grid;ee.show&&Nt(M,ee.filter(r,v,e,f,x),i,i==0?2:1,i==0?Ce:Se,i==0?Te:we,ni(ee.width*Un,3),ee.stroke(r,e),ee.dash,ee.cap),C.show&&Nt([O],[1],+(i==0),i==0?1:2,i==1?Ce:Se,i==1?Te:we,ni(C.width*Un,3),C.stroke(r,e),C.dash,C.cap)}Ni(`drawAxes`)}function Lt(e){v.forEach((t,n)=>{n>0&&(t._paths=null,e&&(i==1?(t.min=null,t.max=null):t.facets.forEach(e=>{e.min=null,e.max=null})))})}let Rt=!1,zt=!1,Bt=[];function Vt(){zt=!1;for(let e=0;e<Bt.length;e++)Ni(...Bt[e]);Bt.length=0}function Ht(){Rt||=(wi(Wt),!0)}function Ut(e,t=!1){Rt=!0,zt=t,e(r),Wt(),t&&Bt.length>0&&queueMicrotask(Vt)}r.batch=Ut;function Wt(){if(Ee&&=(Ct(),!1),Oe&&=(Pe(),!1),De){if(Jn(p,wn,ye),Jn(p,Sn,U),Jn(p,bn,V),Jn(p,xn,H),Jn(m,wn,ye),Jn(m,Sn,U),Jn(m,bn,V),Jn(m,xn,H),Jn(f,bn,ve),Jn(f,xn,B),u.width=Ar(ve*Un),u.height=Ar(B*Un),y.forEach(({_el:e,_show:t,_size:n,_pos:r,side:i})=>{if(e!=null){if(t){let t=i===3||i===0?n:0,a=i%2==1;Jn(e,a?`left`:`top`,r-t),Jn(e,a?`width`:`height`,n),Jn(e,a?`top`:`left`,a?U:ye),Jn(e,a?`height`:`width`,a?H:V),qn(e,cn)}else Kn(e,cn)}}),lt=ut=dt=pt=mt=ht=gt=_t=ft=null,vt=1,ui(!0),ye!=be||U!=W||V!=G||H!=xe){Lt(!1);let e=V/G,t=H/xe;if(I&&!ke&&F.left>=0){F.left*=e,F.top*=t,Jt&&Qn(Jt,Ar(F.left),0,V,H),Yt&&Qn(Yt,0,Ar(F.top),V,H);for(let n=0;n<Ue.length;n++){let r=Ue[n];r!=null&&(We[n]*=e,Ge[n]*=t,Qn(r,jr(We[n]),jr(Ge[n]),V,H))}}if($n.show&&!Ae&&$n.left>=0&&$n.width>0){$n.left*=e,$n.width*=e,$n.top*=t,$n.height*=t;for(let e in yi)Jn(tr,e,$n[e])}be=ye,W=U,G=V,xe=H}Ni(`setSize`),De=!1}ve>0&&B>0&&(d.clearRect(0,0,u.width,u.height),Ni(`drawClear`),w.forEach(e=>e()),Ni(`draw`)),$n.show&&Ae&&(rr($n),Ae=!1),I&&ke&&(ti(null,!0,!1),ke=!1),P.show&&P.live&&je&&(Qr(),je=!1),c||(c=!0,r.status=1,Ni(`ready`)),ot=!1,Rt=!1}r.redraw=(e,t)=>{Oe=t||!1,e===!1?Ht():cr(S,D.min,D.max)};function Gt(e,n){let i=b[e];if(i.from==null){if(tt==0){let t=i.range(r,n.min,n.max,e);n.min=t[0],n.max=t[1]}if(n.min>n.max){let e=n.min;n.min=n.max,n.max=e}if(tt>1&&n.min!=null&&n.max!=null&&n.max-n.min<1e-16)return;e==S&&i.distr==2&&tt>0&&(n.min=sr(n.min,t[0]),n.max=sr(n.max,t[0]),n.min==n.max&&n.max++),j[e]=n,Ee=!0,Ht()}}r.setScale=Gt;let Kt,qt,Jt,Yt,Xt,Zt,Qt,En,Pn,Fn,In,zn,Hn=!1,Wn=F.drag,Gn=Wn.x,Zn=Wn.y;I&&(F.x&&(Kt=Xn(un,m)),F.y&&(qt=Xn(dn,m)),D.ori==0?(Jt=Kt,Yt=qt):(Jt=qt,Yt=Kt),In=F.left,zn=F.top);let $n=r.select=vi({show:!0,over:!0,left:0,width:0,top:0,height:0},e.select),tr=$n.show?Xn(ln,$n.over?m:p):null;function rr(e,t){if($n.show){for(let t in e)$n[t]=e[t],t in yi&&Jn(tr,t,e[t]);t!==!1&&Ni(`setSelect`)}}r.setSelect=rr;function ir(e){if(v[e].show)ie&&qn(oe[e],cn);else if(ie&&Kn(oe[e],cn),I){let t=He?Ue[0]:Ue[e];t!=null&&Qn(t,-10,-10,V,H)}}function cr(e,t,n){Gt(e,{min:t,max:n})}function lr(e,t,n,a){t.focus!=null&&Er(e),t.show!=null&&v.forEach((n,r)=>{r>0&&(e==r||e==null)&&(n.show=t.show,ir(r),i==2?(cr(n.facets[0].scale,null,null),cr(n.facets[1].scale,null,null)):cr(n.scale,null,null),Ht())}),n!==!1&&Ni(`setSeries`,e,t),a&&zi(`setSeries`,r,e,t)}r.setSeries=lr;function ur(e,t){vi(x[e],t)}function dr(e,t){e.fill=Wr(e.fill||null),e.dir=xr(e.dir,-1),t??=x.length,x.splice(t,0,e)}function fr(e){e==null?x.length=0:x.splice(e,1)}r.addBand=dr,r.setBand=ur,r.delBand=fr;function vr(e,t){v[e].alpha=t,I&&Ue[e]!=null&&(Ue[e].style.opacity=t),ie&&oe[e]&&(oe[e].style.opacity=t)}let yr,Cr,wr,Tr={focus:!0};function Er(e){if(e!=wr){let t=e==null,n=Be.alpha!=1;v.forEach((r,a)=>{if(i==1||a>0){let i=t||a==0||a==e;r._focus=t?null:i,n&&vr(a,i?1:Be.alpha)}}),wr=e,n&&Ht()}}ie&&Ve&&ge(Mn,R,e=>{F._lock||(Re(e),wr!=null&&lr(null,Tr,!0,Fi.setSeries))});function kr(e,t,n){let r=b[t];n&&(e=e/Un-(r.ori==1?U:ye));let i=V;r.ori==1&&(i=H,e=i-e),r.dir==-1&&(e=i-e);let a=r._min,o=r._max,s=e/i,c=a+(o-a)*s,l=r.distr;return l==3?Pr(10,c):l==4?Rr(c,r.asinh):l==100?r.bwd(c):c}function Fr(e,n){return sr(kr(e,S,n),t[0],nt,rt)}r.valToIdx=e=>sr(e,t[0]),r.posToIdx=Fr,r.posToVal=kr,r.valToPos=(e,t,n)=>b[t].ori==0?a(e,b[t],n?we:V,n?Se:0):o(e,b[t],n?Te:H,n?Ce:0),r.setCursor=(e,t,n)=>{In=e.left,zn=e.top,ti(null,t,n)};function Lr(e,t){Jn(tr,wn,$n.left=e),Jn(tr,bn,$n.width=t)}function Vr(e,t){Jn(tr,Sn,$n.top=e),Jn(tr,xn,$n.height=t)}let Gr=D.ori==0?Lr:Vr,Kr=D.ori==1?Lr:Vr;function Zr(){if(ie&&P.live)for(let e=+(i==2);e<v.length;e++){if(e==0&&le)continue;let t=P.values[e],n=0;for(let r in t)se[e][n++].firstChild.nodeValue=t[r]}}function Qr(e,t){if(e!=null&&(e.idxs?e.idxs.forEach((e,t)=>{re[t]=e}):di(e.idx)||re.fill(e.idx),P.idx=re[0]),ie&&P.live){for(let e=0;e<v.length;e++)(e>0||i==1&&!le)&&ei(e,re[e]);Zr()}je=!1,t!==!1&&Ni(`setLegend`)}r.setLegend=Qr;function ei(e,n){let i=v[e],a=e==0&&O==2?at:t[e],o;le?o=i.values(r,e,n)??ue:(o=i.value(r,n==null?null:a[n],e,n),o=o==null?ue:{_:o}),P.values[e]=o}function ti(e,n,a){Pn=In,Fn=zn,[In,zn]=F.move(r,In,zn),F.left=In,F.top=zn,I&&(Jt&&Qn(Jt,Ar(In),0,V,H),Yt&&Qn(Yt,0,Ar(zn),V,H));let o,s=nt>rt;yr=Br,Cr=null;let c=D.ori==0?V:H,l=D.ori==1?V:H;if(In<0||tt==0||s){o=F.idx=null;for(let e=0;e<v.length;e++){let t=Ue[e];t!=null&&Qn(t,-10,-10,V,H)}Ve&&lr(null,Tr,!0,e==null&&Fi.setSeries),P.live&&(re.fill(o),je=!0)}else{let e,n,a;i==1&&(e=D.ori==0?In:zn,n=kr(e,S),o=F.idx=sr(n,t[0],nt,rt),a=k(t[0][o],D,c,0));let s=-10,u=-10,d=0,f=0,p=!0,m=``,h=``;for(let e=+(i==2);e<v.length;e++){let g=v[e],_=re[e],y=_==null?null:i==1?t[e][_]:t[e][1][_],x=F.dataIdx(r,e,o,n),S=x==null?null:i==1?t[e][x]:t[e][1][x];if(je=je||S!=y||x!=_,re[e]=x,e>0&&g.show){let n=x==null?-10:x==o?a:k(i==1?t[0][x]:t[e][0][x],D,c,0),_=S==null?-10:A(S,i==1?b[g.scale]:b[g.facets[1].scale],l,0);if(Ve&&S!=null){let t=D.ori==1?In:zn,n=Or(Be.dist(r,e,x,_,t));if(n<yr){let r=Be.bias;if(r!=0){let i=kr(t,g.scale),a=S>=0?1:-1,o=i>=0?1:-1;o==a&&(o==1?r==1?S>=i:S<=i:r==1?S<=i:S>=i)&&(yr=n,Cr=e)}else yr=n,Cr=e}}if(je||He){let t,i;D.ori==0?(t=n,i=_):(t=_,i=n);let a,o,c,l,g,v,y=!0,b=ze.bbox;if(b!=null){y=!1;let t=b(r,e);c=t.left,l=t.top,a=t.width,o=t.height}else c=t,l=i,a=o=ze.size(r,e);if(v=ze.fill(r,e),g=ze.stroke(r,e),He)e==Cr&&yr<=Be.prox&&(s=c,u=l,d=a,f=o,p=y,m=v,h=g);else{let t=Ue[e];t!=null&&(We[e]=c,Ge[e]=l,nr(t,a,o,y),er(t,v,g),Qn(t,jr(c),jr(l),V,H))}}}}if(He){let e=Be.prox;if(je||(wr==null?yr<=e:yr>e||Cr!=wr)){let e=Ue[0];e!=null&&(We[0]=s,Ge[0]=u,nr(e,d,f,p),er(e,m,h),Qn(e,jr(s),jr(u),V,H))}}}if($n.show&&Hn){if(e!=null){let[t,n]=Fi.scales,[r,i]=Fi.match,[a,o]=e.cursor.sync.scales,s=e.cursor.drag;if(Gn=s._x,Zn=s._y,Gn||Zn){let{left:s,top:u,width:d,height:f}=e.select,p=e.scales[a].ori,m=e.posToVal,h,g,_,v,y,x=t!=null&&r(t,a),S=n!=null&&i(n,o);x&&Gn?(p==0?(h=s,g=d):(h=u,g=f),_=b[t],v=k(m(h,a),_,c,0),y=k(m(h+g,a),_,c,0),Gr(Mr(v,y),Or(y-v))):Gr(0,c),S&&Zn?(p==1?(h=s,g=d):(h=u,g=f),_=b[n],v=A(m(h,o),_,l,0),y=A(m(h+g,o),_,l,0),Kr(Mr(v,y),Or(y-v))):Kr(0,l)}else bi()}else{let e=Or(Pn-Xt),t=Or(Fn-Zt);if(D.ori==1){let n=e;e=t,t=n}Gn=Wn.x&&e>=Wn.dist,Zn=Wn.y&&t>=Wn.dist;let n=Wn.uni;n==null?Wn.x&&Wn.y&&(Gn||Zn)&&(Gn=Zn=!0):Gn&&Zn&&(Gn=e>=n,Zn=t>=n,!Gn&&!Zn&&(t>e?Zn=!0:Gn=!0));let r,i;Gn&&(D.ori==0?(r=Qt,i=In):(r=En,i=zn),Gr(Mr(r,i),Or(i-r)),Zn||Kr(0,l)),Zn&&(D.ori==1?(r=Qt,i=In):(r=En,i=zn),Kr(Mr(r,i),Or(i-r)),Gn||Gr(0,c)),!Gn&&!Zn&&(Gr(0,0),Kr(0,0))}}if(Wn._x=Gn,Wn._y=Zn,e==null){if(a){if(Li!=null){let[e,t]=Fi.scales;Fi.values[0]=e==null?null:kr(D.ori==0?In:zn,e),Fi.values[1]=t==null?null:kr(D.ori==1?In:zn,t)}zi(On,r,In,zn,V,H,o)}if(Ve){let e=a&&Fi.setSeries,t=Be.prox;wr==null?yr<=t&&lr(Cr,Tr,!0,e):yr>t?lr(null,Tr,!0,e):Cr!=wr&&lr(Cr,Tr,!0,e)}}je&&(P.idx=o,Qr()),n!==!1&&Ni(`setCursor`)}let ai=null;Object.defineProperty(r,"rect",{get(){return ai??ui(!1),ai}});function ui(e=!1){e?ai=null:(ai=m.getBoundingClientRect(),Ni(`syncRect`,ai))}function hi(e,t,n,r,i,a,o){F._lock||Hn&&e!=null&&e.movementX==0&&e.movementY==0||(gi(e,t,n,r,i,a,o,!1,e!=null),e==null?ti(t,!0,!1):ti(null,!0,!0))}function gi(e,t,n,i,a,o,c,l,u){if(ai??ui(!1),Re(e),e!=null)n=e.clientX-ai.left,i=e.clientY-ai.top;else{if(n<0||i<0){In=-10,zn=-10;return}let[e,r]=Fi.scales,c=t.cursor.sync,[l,u]=c.values,[d,f]=c.scales,[p,m]=Fi.match,h=t.axes[0].side%2==1,g=D.ori==0?V:H,_=D.ori==1?V:H,v=h?o:a,y=h?a:o,x=h?i:n,S=h?n:i;if(n=d==null?x/v*g:p(e,d)?s(l,b[e],g,0):-10,i=f==null?S/y*_:m(r,f)?s(u,b[r],_,0):-10,D.ori==1){let e=n;n=i,i=e}}u&&(t==null||t.cursor.event.type==On)&&((n<=1||n>=V-1)&&(n=$r(n,V)),(i<=1||i>=H-1)&&(i=$r(i,H))),l?(Xt=n,Zt=i,[Qt,En]=F.move(r,n,i)):(In=n,zn=i)}let yi={width:0,height:0,left:0,top:0};function bi(){rr(yi,!1)}let xi,Si,Ci,Ti;function Ei(e,t,n,i,a,o,s){Hn=!0,Gn=Zn=Wn._x=Wn._y=!1,gi(e,t,n,i,a,o,s,!0,!1),e!=null&&(ge(An,Bn,Di,!1),zi(kn,r,Qt,En,V,H,null));let{left:c,top:l,width:u,height:d}=$n;xi=c,Si=l,Ci=u,Ti=d}function Di(e,t,n,i,a,o,s){Hn=Wn._x=Wn._y=!1,gi(e,t,n,i,a,o,s,!1,!0);let{left:c,top:l,width:u,height:d}=$n,f=u>0||d>0,p=xi!=c||Si!=l||Ci!=u||Ti!=d;if(f&&p&&rr($n),Wn.setScale&&f&&p){let e=c,t=u,n=l,r=d;if(D.ori==1&&(e=l,t=d,n=c,r=u),Gn&&cr(S,kr(e,S),kr(e+t,S)),Zn)for(let e in b){let t=b[e];e!=S&&t.from==null&&t.min!=Br&&cr(e,kr(n+r,e),kr(n,e))}bi()}else F.lock&&(F._lock=!F._lock,ti(t,!0,e!=null));e!=null&&(_e(An,Bn),zi(An,r,In,zn,V,H,null))}function Oi(e,t,n,r,i,a,o){if(F._lock)return;Re(e);let s=Hn;if(Hn){let e=!0,t=!0,n,r;D.ori==0?(n=Gn,r=Zn):(n=Zn,r=Gn),n&&r&&(e=In<=10||In>=V-10,t=zn<=10||zn>=H-10),n&&e&&(In=In<Qt?0:V),r&&t&&(zn=zn<En?0:H),ti(null,!0,!0),Hn=!1}In=-10,zn=-10,re.fill(null),ti(null,!0,!0),s&&(Hn=s)}function ki(e,t,n,i,a,o,s){F._lock||(Re(e),ct(),bi(),e!=null&&zi(Nn,r,In,zn,V,H,null))}function Ai(){y.forEach(is),Me(r.width,r.height,!0)}ar(Ln,Vn,Ai);let ji={};ji.mousedown=Ei,ji.mousemove=hi,ji.mouseup=Di,ji.dblclick=ki,ji.setSeries=(e,t,n,i)=>{let a=Fi.match[2];n=a(r,t,n),n!=-1&&lr(n,i,!0,!1)},I&&(ge(kn,m,Ei),ge(On,m,hi),ge(jn,m,e=>{Re(e),ui(!1)}),ge(Mn,m,Oi),ge(Nn,m,ki),Ho.add(r),r.syncRect=ui);let Mi=r.hooks=e.hooks||{};function Ni(e,t,n){zt?Bt.push([e,t,n]):e in Mi&&Mi[e].forEach(e=>{e.call(null,r,t,n)})}(e.plugins||[]).forEach(e=>{for(let t in e.hooks)Mi[t]=(Mi[t]||[]).concat(e.hooks[t])});let Pi=(e,t,n)=>n,Fi=vi({key:null,setSeries:!1,filters:{pub:Yr,sub:Yr},scales:[S,v[1]?v[1].scale:null],match:[Xr,Xr,Pi],values:[null,null]},F.sync);Fi.match.length==2&&Fi.match.push(Pi),F.sync=Fi;let Li=Fi.key,Ri=co(Li);function zi(e,t,n,r,i,a,o){Fi.filters.pub(e,t,n,r,i,a,o)&&Ri.pub(e,t,n,r,i,a,o)}Ri.sub(r);function Bi(e,t,n,r,i,a,o){Fi.filters.sub(e,t,n,r,i,a,o)&&ji[e](null,t,n,r,i,a,o)}r.pub=Bi;function Vi(){Ri.unsub(r),Ho.delete(r),he.clear(),or(Ln,Vn,Ai),l.remove(),R?.remove(),Ni(`destroy`)}r.destroy=Vi;function Hi(){Ni(`init`,e,t),st(t||e.data,!1),j[S]?Gt(S,j[S]):ct(),Ae=$n.show&&($n.width>0||$n.height>0),ke=je=!0,Me(e.width,e.height)}return v.forEach(qe),y.forEach(Ze),n?n instanceof HTMLElement?(n.appendChild(l),Hi()):n(r,Hi):Hi(),r}as.assign=vi,as.fmtNum=Tr,as.rangeNum=br,as.rangeLog=mr,as.rangeAsinh=hr,as.orient=fo,as.pxRatio=Un,as.join=Ci,as.fmtDate=Ii,as.tzDate=Ri,as.sync=co;{as.addGap=_o,as.clipGaps=go;let e=as.paths={points:jo};e.linear=Fo,e.stepped=Io,e.bars=Ro,e.spline=Bo}var os=1/200,ss=class{#e;#t=[];get part(){return this.#e}onChange(e){this.#t.push(e)}show(e){this.#e=e;for(let e of this.#t)e()}};function cs(e,t){return e<t?[e,t]:[t,e]}function ls([e,t],n,r){return[r-(r-e)*n,r+(t-r)*n]}function us([e,t],n){let r=n*(t-e);return[e+r,t+r]}function ds([e,t],n){let r=t-e;if(!(r<n[1]-n[0]))return;let i=Math.min(Math.max(e,n[0]),n[1]-r);return[i,i+r]}function fs([e,t],n){let r=Math.max(t-e,os*(n[1]-n[0]))/2,i=(e+t)/2;return[i-r,i+r]}function ps(e,t,[n,r]){let i=[];for(let a=0;a<t.length;a++){let[o,s]=[t[a],e[a]??NaN];n<=o&&o<=r&&i.push(s);let[c,l]=[t[a-1]??NaN,e[a-1]??NaN];for(let e of[n,r])(c-e)*(o-e)<0&&i.push(l+(s-l)*(e-c)/(o-c))}return i}function ms(e,[t,n]){let r=new Set;for(let i=1;i<e.length;i++){let[a,o]=cs(e[i-1],e[i]);a<=n&&o>=t&&r.add(i-1).add(i)}return r}function hs(e,t,n,r=!1){return(n&&Ae(e.map(e=>ps(e,t,n)),r))??Ae(e,r)}var gs=400,_s=120,vs={width:330,height:190},ys=66,bs=6,xs=`M6.5 2a4.5 4.5 0 1 0 0 9a4.5 4.5 0 1 0 0 -9M10 10l4 4M4.5 6.5h4M6.5 4.5v4`,Ss=4,Cs=.5,ws=.25,Ts=class{state;time;element;area=e(`div`,{class:`area`});overlay;content={title:``,unit:``,lines:[]};#e=e(`h3`);#t=e(`ul`,{class:`legend`});#n=e(`p`,{class:`caption`});#r=e(`li`,{class:`moment`});#i=e(`div`,{class:`now`});#a=e(`div`,{class:`pointer`,hidden:!0});#o;#s=[];#c;#l=e(`div`,{class:`band`,hidden:!0});#u;#d;#f=new ss;#p=e(`button`,{type:`button`,class:`icon`,"data-testid":`closer`,title:`Closer (+); drag along the axis, or with Shift, to choose what is seen`,"aria-label":`see closer`,onclick:()=>this.#E(Cs)},r(`svg`,{viewBox:`0 0 16 16`,"aria-hidden":`true`},r(`path`,{d:xs})));#m=e(`button`,{type:`button`,class:`icon`,"data-testid":`whole`,title:`The whole (0)`,"aria-label":`show the whole`,onclick:()=>this.#O(void 0)},`whole`);#h;constructor(t,n,r=[],i=new ss){this.state=t,this.time=i;let a=e(`figcaption`,{},this.#e,...r);this.element=e(`figure`,{class:`plot`,"data-testid":n},a,e(`div`,{class:`above`},this.#t,e(`span`,{class:`zoom`},this.#p,this.#m)),this.area,this.#n),new ResizeObserver(([{contentRect:e}])=>{this.#h={width:Math.round(e.width),height:Math.round(e.height)},this.#o?.setSize(this.#g())}).observe(this.area),this.area.addEventListener(`keydown`,e=>this.#w(e)),t.onTime(()=>this.#j());for(let e of[this.time,this.#f])e.onChange(()=>this.#k())}get canvas(){return this.#o?.ctx.canvas}show(r){this.#o?.destroy(),this.#o=void 0,r.over?.label!==this.content.over?.label&&this.#f.show(void 0),this.content={...r,part:(r.over?this.#f:this.time).part},this.#c=this.#d=this.#u=void 0,this.#e.textContent=d(r.title,r.message?``:r.unit),this.#n.replaceChildren(...t(r.caption??``)),this.area.replaceChildren(),this.#s=[];let[i,a]=this.#D();if(this.#p.hidden=r.message!==void 0||i===a,this.#m.hidden=this.content.part===void 0||this.#p.hidden,r.message){for(let e of[`role`,`tabindex`,`aria-label`])this.area.removeAttribute(e);this.#t.replaceChildren(),this.area.append(e(`p`,{class:`message`},...t(r.message)));return}this.area.setAttribute(`role`,`application`),this.area.tabIndex=0,this.area.setAttribute(`aria-label`,`${d(r.title,r.unit)} over ${r.over?.label??`time`}: plus and minus zoom, 0 shows the whole`);let o=r.lines.map(e=>this.#v(e));n(this.#t,()=>this.#t.replaceChildren(this.#r,...o));let s=r.over?Ps(r.over.curve,r):js(this.state,r);this.#o=new as(this.#_(this.content),s,this.area),this.#o.over.append(this.#l,this.#i,this.#a),this.#y(this.#o),this.overlay?.onto(this.#o),this.#j()}lay(e){this.overlay=e,this.#o&&(e?.onto(this.#o),this.#o.setData(this.#o.data))}remove(){this.#o?.destroy(),this.#o=void 0,this.element.remove()}#g(){if(document.documentElement.classList.contains(`printing`))return vs;let{width:e,height:t}=this.#h??={width:this.area.clientWidth,height:this.area.clientHeight};return{width:e||gs,height:Math.max(t,_s)}}#_(e){let{units:t}=this.state.report,n=i(`--muted`),r={stroke:i(`--rule`),width:1},a={stroke:n,grid:r,ticks:{...r,size:4},font:i(`--plot-font`),labelFont:i(`--plot-font`)},o=(e,t)=>t.map(e=>s(e,6)),{over:c,logarithmic:u}=e,f=(e,t)=>this.content.part??(c?C(e,t):[e,t]),p=(t,n)=>{let[r,i]=(this.content.part&&this.#A())??[t,n];if(u)return S(r,i);let a=C(...Ds(r,i,e));return this.overlay?.reach(...a)??a},m=c?d(c.label,c.unit):d(`time`,t.time);return{mode:c?2:1,hooks:{drawClear:[t=>ks(t,e)],draw:[()=>(this.#j(),this.overlay?.drawn())]},...this.#g(),legend:{show:!1},cursor:{show:!1,drag:{x:!1,y:!1,setScale:!1}},scales:{x:{time:!1,range:(e,t,n)=>[...f(t,n)]},y:{...u&&Fs,range:(e,t,n)=>p(t,n)}},axes:[{...a,values:o,size:30,label:m,labelSize:18,labelGap:0,gap:3},{...a,values:u?Is:o,size:ys,label:l(e.unit)||`1`,labelSize:18,gap:4}],series:[{},...e.lines.map(c?Ms:As)]}}#v(t){let n=e(`output`);this.#s.push({curve:t.curve,output:n});let r=[e(`span`,{class:`swatch ${t.marks?`ring`:t.dash?t.dash[0]<3?`dotted`:`dashed`:``}`,style:`--swatch: ${t.color}`}),e(`span`,{class:`label`},t.label),n],i=t.pick&&(t.width??0)>2;return e(`li`,{},t.pick?e(`button`,{type:`button`,name:t.label,onclick:t.pick,"aria-pressed":String(!!i)},...r):e(`span`,{},...r))}#y({over:e,root:t}){let n=t.querySelector(`.u-axis`);n.classList.add(`abscissa`);for(let t of[e,n])t.addEventListener(`pointerenter`,()=>this.#d=void 0),t.addEventListener(`pointerdown`,e=>{t.setPointerCapture(e.pointerId),e.button===0&&(t===n||e.shiftKey?this.#u=this.#b(e):this.#x(e))}),t.addEventListener(`pointermove`,n=>{this.#u===void 0?t===e&&this.#x(n):this.#S(this.#b(n))}),t.addEventListener(`pointerup`,e=>this.#C(this.#b(e))),t.addEventListener(`pointercancel`,()=>this.#C()),t.addEventListener(`dblclick`,()=>this.#O(void 0));e.addEventListener(`pointerleave`,()=>{this.#c=void 0,this.#j()})}#b({clientX:e}){return e-(this.#d??=this.#o?.over.getBoundingClientRect().left??0)}#x(e){if(!this.#o)return;let t=this.#o.posToVal(this.#b(e),`x`),{over:n}=this.content,{times:r}=this.state.report,i=n?O(n.curve,t,this.state.step):A(r,t);this.#c=e.buttons===1?void 0:i,e.buttons===1?(this.state.pause(),this.state.goToStep(i)):this.#j()}#S(e){let[t,n]=cs(this.#u,e);this.#l.hidden=n-t<Ss,Object.assign(this.#l.style,{left:`${t}px`,width:`${n-t}px`})}#C(e){let t=this.#u;if(this.#u=void 0,this.#l.hidden=!0,t===void 0||e===void 0||Math.abs(e-t)<Ss)return;let n=e=>this.#o.posToVal(e,`x`);this.#O(cs(n(t),n(e)))}#w(e){let t=e.ctrlKey||e.metaKey||e.altKey?void 0:this.#T(e);t&&this.#o&&(e.preventDefault(),t())}#T({key:e,shiftKey:t}){if(e===`+`||e===`=`)return()=>this.#E(Cs);if(e===`-`||e===`_`)return()=>this.#E(1/Cs);if(e===`0`)return()=>this.#O(void 0);let n={ArrowLeft:-.25,ArrowRight:ws}[e];return t&&n?()=>this.content.part&&this.#O(us(this.content.part,n)):void 0}#E(e){let t=this.content.part??this.#D(),[n,r]=t,i=k(this.content.over?.curve??this.state.report.times,this.state.step);this.#O(ls(t,e,n<=i&&i<=r?i:(n+r)/2))}#D(){let{over:e}=this.content,[t,n]=Ae([e?.curve??this.state.report.times])??[0,0];return e?C(t,n):[t,n]}#O(e){let t=this.#D();(this.content.over?this.#f:this.time).show(e&&ds(fs(e,t),t))}#k(){this.#o&&(this.content.part=(this.content.over?this.#f:this.time).part,document.activeElement===this.#m&&this.#p.focus(),this.#m.hidden=this.content.part===void 0,this.#o.setData(this.#o.data))}#A(){let{lines:e,over:t,part:n,logarithmic:r}=this.content;return hs(e.map(({curve:e,marks:t})=>t??e),t?.curve??this.state.report.times,n,r)}#j(){if(!this.#o)return;let{over:e,unit:t}=this.content,n=t=>k(e?e.curve:this.state.report.times,t),[r,i]=this.content.part??[-1/0,1/0],a=(e,t)=>{let a=t===void 0?NaN:n(t);e.hidden=!(r<=a&&a<=i),e.hidden||(e.style.left=`${this.#o.valToPos(a,`x`)}px`)};a(this.#i,this.state.step),a(this.#a,this.#c);let o=this.#c??this.state.step;this.#r.textContent=e?`${e.label} ${Es(n(o),e.unit)}`:Es(n(o),this.state.report.units.time),this.#r.classList.toggle(`pointed`,this.#c!==void 0);for(let{curve:e,output:n}of this.#s)n.textContent=Es(k(e,o),t)}};function Es(e,t){return`${s(e,4)} ${l(t)}`.trimEnd()}function Ds(e,t,{wanted:n=[]}){if(e===null||t===null)return[e,t];let r=n.flatMap(e=>[e.low,e.high]).filter(e=>e!==null),i=2*(t-e),a=r.filter(n=>n>e-i&&n<t+i);return[Math.min(e,...a),Math.max(t,...a)]}var Os=10;function ks(e,{wanted:t=[]}){let{ctx:n,bbox:r}=e;n.save(),n.beginPath(),n.rect(r.left,r.top,r.width,r.height),n.clip(),n.fillStyle=i(`--good`);for(let{low:i,high:a,at:o}of t){let t=a===null?r.top:e.valToPos(a,`y`,!0),s=i===null?r.top+r.height:e.valToPos(i,`y`,!0),c=Os/2*devicePixelRatio,[l,u]=o===void 0?[r.left,r.width]:[e.valToPos(o,`x`,!0)-c,2*c];n.globalAlpha=o===void 0?.12:.35,n.fillRect(l,t,u,Math.max(s-t,2))}n.restore()}function As(e){let t=e.width??1.8;return e.marks?{stroke:e.color,paths:()=>null,points:{show:!0,size:7,width:1.5,stroke:e.color,fill:i(`--page`)}}:{stroke:e.color,width:t,dash:e.dash,points:{show:!1}}}function js(e,{lines:t,logarithmic:n}){return[Array.from(e.report.times),...t.map(({marks:e,curve:t})=>e??(n?x(t):b(t)))]}function Ms(e){let t=[`x`,`y`].map(e=>({scale:e,auto:!0})),n=e.marks!==void 0;return{stroke:e.color,width:n?1.5:e.width??1.8,dash:e.dash,paths:(e,t)=>{let[r,i]=e.data[t],a=new Path2D,o=!1;for(let t=0;t<r.length;t++){let s=i[t];if(s===null||Number.isNaN(r[t])){o=!1;continue}let[c,l]=[e.valToPos(r[t],`x`,!0),e.valToPos(s,`y`,!0)];n?(a.moveTo(c+Ns,l),a.arc(c,l,Ns,0,2*Math.PI)):o?a.lineTo(c,l):a.moveTo(c,l),o=!0}return{stroke:a}},facets:t,points:{show:!1}}}var Ns=3.5;function Ps(e,{lines:t}){return[null,...t.map(({marks:t,curve:n})=>[e,t??b(n)])]}var Fs={distr:3,log:10};function Is(e,t){let n=t.filter(Ls).length>bs;return t.map(e=>Ls(e)&&!(n&&Math.round(Math.log10(e))%2)?s(e):``)}function Ls(e){let t=Math.log10(e);return Math.abs(t-Math.round(t))<1e-9}var Rs=12;function zs(n){let{status:r,summary:i,notes:a,checks:o,description:s,generator:c,file:l}=n.report;return e(`section`,{class:`checks`,"data-testid":`checks`,"aria-label":`Checks`},s!==``&&e(`p`,{class:`lead`},s),e(`p`,{class:`status`,"data-testid":`status`},...t(r.message)),e(`p`,{class:`origin`},e(`code`,{},l),` · ${c}`),e(`dl`,{class:`summary`,"data-testid":`summary`},...i.map(({label:t,value:n})=>e(`div`,{},e(`dt`,{},t),e(`dd`,{},n)))),a.length>0&&e(`ul`,{class:`notes`,"data-testid":`notes`},...a.map(n=>e(`li`,{},...t(n)))),n.report.margin&&Bs(n),...o.map(Vs))}function Bs(e){let t=new Ts(e,`plot-margin`),n=()=>{let{margin:n}=e.report;if(!n)return;let r=[{label:e.compares?`as loaded`:`margin`,color:i(`--trace`),curve:n.curve}],a=e.present?.margin;a&&(Object.assign(r[0],{color:i(`--former`),dash:[6,4]}),r.unshift({label:`present design`,color:i(`--trace`),curve:a})),t.show({title:`distance from a singular position`,unit:``,lines:r,caption:n.note,logarithmic:!0})};return e.onChoice(n),a(n),queueMicrotask(n),t.element}function Vs(n){return e(`details`,{open:n.rows.length<=Rs},e(`summary`,{},n.title,e(`span`,{class:`count`},String(n.rows.length))),n.note!==``&&e(`p`,{class:`lead`},...t(n.note)),e(`div`,{class:`scroll`,tabindex:0},e(`table`,{},e(`thead`,{},e(`tr`,{},...n.header.map(t=>e(`th`,{scope:`col`},t)))),e(`tbody`,{},...n.rows.map(n=>e(`tr`,{},...n.map(n=>e(`td`,{},...t(n)))))))))}function Hs(e,t,n){let r=[];for(let i of e.variables){let e=i.sensitivities.get(t);e?.curves[n].length&&r.push({variable:i,sensitivity:e,extreme:e.extremes[n],share:0})}let i=r.length>0&&r.every(({variable:e})=>e.typical!==null),a=({variable:e,extreme:t})=>Math.abs(t)*(i?Math.abs(e.typical??0):1),o=({variable:e})=>i?``:e.unit,s=[...new Set(r.map(o))],c=new Map(s.map(e=>[e,Math.max(...r.filter(t=>o(t)===e).map(a))]));for(let e of r){let t=c.get(o(e))??0;e.share=t>0?h(a(e)/t):0}return r.sort((e,t)=>Number(e.share===0)-Number(t.share===0)||s.indexOf(o(e))-s.indexOf(o(t))||t.share-e.share||e.variable.index-t.variable.index)}function Us(e){return e.first??z(e)[0]?.[1][0].index??0}var Ws=5,Gs=[7,5],Ks=[2,4];function qs(e,{quantity:t,order:n,over:r}){let{report:a,former:s,present:c}=e,l=a.quantities[t],u=ie(l,n),d={title:u,unit:l.units[n],lines:[]},f=Ys(e,t,n),p=l.curves[n];if(p.length===0)return{...d,message:Xs(u)};let m=e.foreseen?`foreseen to first order`:c?.name??(e.compares?`present design`:u);if(d.lines.push({label:m,color:i(`--trace`),curve:j(e.curve(t,n),f),width:2.4}),e.compares){let e=s?s.quantities[t]?.[n]??new Float32Array:p;d.lines.push({label:s?.name??`as loaded`,color:i(`--former`),curve:j(e,f),width:1.8,dash:Gs})}let h=a.designs.filter(({kind:e,quantities:r})=>e===`band`&&r[t]?.[n].length);r!==void 0&&h.length>0&&(d.caption=`How far it may be off is known at a time: choose time to see it.`);for(let e of r===void 0?h:[]){let r=j(e.quantities[t][n],f);d.lines.push({label:e.name,color:i(`--former`),curve:r,width:1.3,dash:Ks})}return(c?a.designs.filter(({kind:e})=>e.endsWith(`_order`)).filter(e=>e!==s):[]).forEach((e,r)=>{let i=e.quantities[t]?.[n];i?.length&&d.lines.push({label:e.name,color:o(r+1),curve:j(i,f),width:1.8,dash:Ks})}),n===0&&d.lines.push({label:`wanted`,color:i(`--good`),curve:l.wanted,width:2.4,dash:Ks}),d.lines=d.lines.filter(({curve:e})=>e.length>0),n===0&&r===void 0&&(d.wanted=a.values.filter(({quantity:e,target:n,time:r})=>e===t&&n&&r!==null).map(({target:e,time:t})=>({low:e[0],high:e[1],at:t}))),Zs(e,r,d)}function Js(e,t){let{report:n,choice:r}=e,{order:a}=t,l=n.quantities[t.quantity],u=n.variables[r.variable],d=ie(l,a),f=Hs(n,t.quantity,a),p=f.find(({variable:e})=>e===u),m={title:p?I(l,a,u):`d ${d}`,unit:L(l,a,u),lines:[]};if(l.curves[a].length===0)return{...m,unit:``,message:Xs(d)};if(!p)return{...m,unit:``,message:u.note||`How ${u.name} acts on ${d} is not known.`};let h=Qs(e,t);if(typeof h==`string`)return{...m,message:h};let{seen:g}=h,_=f.filter(({variable:e})=>e.unit===u.unit),v=Math.max(..._.map(({sensitivity:e})=>e.peaks[a])),y=_.filter(({variable:e,share:t},n)=>e===u||n<Ws&&t>0),x=0;m.lines=y.map(({variable:t,sensitivity:n})=>{let r=t===u;return{label:t.name,color:r?i(`--chosen`):o(x++),curve:j(g(n.curves[a],t.index,!1),v),width:r?2.6:1.3,pick:()=>e.choose({variable:t.index})}});let S=m.lines.findIndex(({width:e})=>e===2.6);m.lines.push(...m.lines.splice(S,1));let{differences:C}=p.sensitivity,w=_.length-y.length,T=[h.note,w>0?`${y.length} of ${_.length}.`:``].filter(e=>e!==``).join(` `);if(!C)return Zs(e,t.over,{...m,caption:T});let E=g(C.curves[a],u.index,!0);m.lines.push({label:`finite differences`,color:i(`--ink`),curve:E,marks:b(E)});let D=`${T} Rings: re-solved ±${c(Number(C.step.toPrecision(2)),C.unit)} away, disagreement at most ${s(C.worst[a],2)}.`;return Zs(e,t.over,{...m,caption:D.trimStart()})}function Ys({report:e},t,n){let r=e.quantities[t].units[n];return Math.max(...e.quantities.filter(({units:e})=>e[n]===r).map(({curves:e})=>v(e[n])))}function Xs(e){return`There is no ${e}: the motion is solved up to accelerations, and what goes by a driver up to its value.`}function Zs({report:e},t,n){if(t===void 0||n.message)return n;let{name:r,units:i,curves:a}=e.quantities[t];return{...n,over:{label:r,unit:i[0],curve:a[0]}}}function Qs({report:e},{quantity:t,order:n,over:r}){if(r===void 0)return{seen:e=>e,note:``};let[i,a]=[e.quantities[t],e.quantities[r]];if(n>0)return`Over another quantity, sensitivities are those of values; choose the value, or time.`;let o=$s(e,a.index),s=o?.alone[i.index]?.length?E(o.alone[i.index],o.alone[a.index]):void 0;if(!s&&[i,a].some(({curves:e})=>e[1].length===0||e[2].length===0))return`How ${i.name} goes with ${a.name} is not known along the motion, for one of them has no rate; choose time.`;let c=s??T(i.curves,a.curves);return{seen:(t,n,r)=>{let i=e.variables[n].sensitivities.get(a.index),o=r?i?.differences?.curves[0]:i?.curves[0];return o?D(t,o,c):t},note:s&&o?`At the same ${a.name}, which ${o.name} keeps while other drivers stand.`:``}}function $s({drivers:e},t){let n=({alone:e,travel:n})=>{let[r,i]=Ae([n])??[0,0];return e[t]?.length?v(e[t])*(i-r):0},[r]=[...e].sort((e,t)=>n(t)-n(e));return r&&n(r)>0?r:void 0}var ec=class{state;wish;plot;#e;#t=0;#n;#r;constructor(t,n,r,{onRemove:i,onAdd:o}){this.state=t,this.wish=n,this.#e=n.quantity,this.#r=n.shown;let{report:s}=t,c=tc(`quantity`,`Quantity`,()=>this.#a(c.value),...n.leads?[]:[e(`option`,{value:``},`selected quantity`)],...nc(t)),l=tc(`over`,`Over`,()=>this.#o({over:l.value===``?void 0:Number(l.value)}),e(`option`,{value:``},`over time`),...z(s).flatMap(([,t])=>t.map(({index:t,name:n})=>e(`option`,{value:t},`over ${n}`)))),u=tc(`order`,`Order`,()=>this.#o({order:Number(u.value)}),...M.map((t,n)=>e(`option`,{value:n},t))),d=s.variables.some(({sensitivities:e})=>e.size>0),f=e(`button`,{type:`button`,class:`switch`,"data-testid":`shown`,title:`Draw the sensitivities to the design variables`,onclick:()=>{this.#r=this.#r===`value`?`sensitivity`:`value`,this.show()}},`d / d variable`),p=e(`button`,{type:`button`,class:`icon`,"data-testid":`remove`,title:`Take this curve away`,"aria-label":`Take this curve away`,onclick:()=>i(this)},`×`),m=e(`button`,{type:`button`,class:`icon`,"data-testid":`add-curve`,title:`Add a curve`,"aria-label":`Add a curve`,onclick:o},`+`),h=e(`div`,{class:`controls`},c,l,u,d?f:void 0,n.leads?m:p);this.plot=new Ts(t,n.testId,[h],r),this.plot.element.classList.toggle(`leads`,n.leads),Wt(t,this.plot.element,()=>this.subject.quantity),this.show=()=>{let e=this.subject;c.value=this.#i&&!n.leads?``:String(e.quantity),l.value=e.over===void 0?``:String(e.over),u.value=String(e.order),this.plot.element.classList.toggle(`untitled`,!this.#i||n.leads?this.#r===`value`:!1),f.setAttribute(`aria-pressed`,String(this.#r===`sensitivity`)),this.plot.show(this.#r===`value`?qs(t,e):Js(t,e))},a(()=>this.show())}show;get subject(){let{quantity:e,order:t,over:n}=this.state.choice;return this.#i?{quantity:e,order:t,over:n}:{quantity:this.#e,order:this.#t,over:this.#n}}get#i(){return this.#e===void 0}#a(e){if(this.wish.leads)return this.state.choose({quantity:Number(e)});let{order:t,over:n}=this.subject;this.#e=e===``?void 0:Number(e),this.#t=t,this.#n=n,this.show()}#o(e){if(this.#i)return this.state.choose(e);`order`in e?this.#t=e.order:this.#n=e.over,this.show()}};function tc(t,n,r,...i){return e(`select`,{"data-testid":t,"aria-label":n,title:n,onchange:r},...i)}function nc(t){let n=e=>e===`body`?`bodies`:`${e}s`;return z(t.report).map(([t,r])=>e(`optgroup`,{label:n(t)},...r.map(({index:t,name:n})=>e(`option`,{value:t},n))))}var rc=class{state;element;figures=[];#e=e(`div`,{class:`figures`});#t=0;#n=new ss;constructor(t){this.state=t,this.element=e(`section`,{class:`curves`,"aria-label":`Curves`,"data-testid":`curves`},this.#e),this.#r(`value`);let{quantity:n}=t.choice;Hs(t.report,n,0).length>0?this.#r(`sensitivity`):t.report.quantities.length>1&&this.#r(`value`,this.#o()),t.onChoice(()=>this.#s()),queueMicrotask(()=>this.#s())}#r(e,t){let n=this.#t++,r=new ec(this.state,{quantity:t,shown:e,testId:`plot-${n}`,leads:n===0},this.#n,{onRemove:e=>this.#a(e),onAdd:()=>this.#i()});return this.figures.push(r),this.#e.append(r.plot.element),r}#i(){let e=this.#r(`value`,this.#o());e.show(),e.plot.element.scrollIntoView({block:`nearest`}),e.plot.element.querySelector(`select`)?.focus()}#a(e){this.figures.splice(this.figures.indexOf(e),1),e.plot.remove()}#o(){let e=this.figures.map(({subject:e})=>e.quantity),t=z(this.state.report).flatMap(([,e])=>e);return(t.find(({index:t})=>!e.includes(t))??t[0]).index}#s(){for(let e of this.figures)e.show()}};function ic(e){return new Blob([ac(e)],{type:`text/csv;charset=utf-8`})}function ac(e){let t=Math.max(0,...e.map(({curve:e})=>e.length)),n=[e.map(({label:e,unit:t})=>cc(sc(d(e,t))))];for(let r=0;r<t;r++)n.push(e.map(({curve:e})=>oc(e[r])));return n.map(e=>`${e.join(`,`)}\r\n`).join(``)}function oc(e){if(e===void 0||!Number.isFinite(e))return``;for(let t=6;t<9;t++){let n=Number(e.toPrecision(t));if(Math.fround(n)===Math.fround(e))return String(n)}return String(Number(e.toPrecision(9)))}function sc(e){return/^[=+\-@\t\r]/.test(e)?`'${e}`:e}function cc(e){return/[",\r\n]/.test(e)?`"${e.replaceAll(`"`,`""`)}"`:e}function lc(e){return new Promise((t,n)=>e.toBlob(e=>e?t(e):n(Error(`the picture is too large for this browser`)),`image/png`))}function uc(e,t,{page:n,text:r}){let i=devicePixelRatio,a=26*i,o=document.createElement(`canvas`);o.width=e.width,o.height=e.height+a;let s=o.getContext(`2d`);return s.fillStyle=n,s.fillRect(0,0,o.width,o.height),s.fillStyle=r,s.font=`600 ${14*i}px system-ui, sans-serif`,s.fillText(t,12*i,18*i,o.width-24*i),s.drawImage(e,0,a),lc(o)}function dc(e){let t={"&":`&amp;`,"<":`&lt;`,">":`&gt;`,'"':`&quot;`};return e.replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f]/g,``).replace(/[&<>"]/g,e=>t[e])}function fc(e,t,...n){let r=`<${e}${Object.entries(t).map(([e,t])=>t===void 0?``:` ${e}="${typeof t==`number`?pc(t):dc(t)}"`).join(``)}`;return n.length>0?`${r}>${n.join(``)}</${e}>`:`${r}/>`}function pc(e){return String(Math.round(e*100)/100)}function mc(e,t,n,...r){let i=fc(`svg`,{xmlns:`http://www.w3.org/2000/svg`,width:pc(e),height:pc(t),viewBox:`0 0 ${pc(e)} ${pc(t)}`},fc(`title`,{},dc(n)),...r);return new Blob([`<?xml version="1.0" encoding="UTF-8"?>\n${i}\n`],{type:`image/svg+xml`})}var[hc,gc]=[640,360],[_c,vc,yc,bc]=[78,16,34,46],xc=18,Sc=6.4,Cc=22,wc=[null,null],Tc=`system-ui, sans-serif`,Ec=3;function Dc(e,t,n,r){let i=e.over?.curve??t,a=e.over?d(e.over.label,e.over.unit):d(`time`,n),o=Mc(e.lines),s=gc-bc,c=gc+o.height,[u,f]=Ae([i])??wc,p=u===null||f===null||e.over||u===f?C(u,f):[u,f],m=De(e.part?[...e.part]:p,_c,hc-vc,8),h=Oc(e,i,s),g=(e,t,n={})=>fc(`text`,{x:e[0],y:e[1],fill:r.muted,...n},dc(t)),_=(e,t,n,i)=>fc(`line`,{x1:e,y1:t,x2:n,y2:i,stroke:r.rule,"stroke-width":1}),v=(yc+s)/2;return mc(hc,c,e.title,fc(`rect`,{width:hc,height:c,fill:r.page}),fc(`g`,{"font-family":Tc,"font-size":12},g([_c,20],d(e.title,e.unit),{fill:r.text,"font-size":14,"font-weight":600}),...m.ticks.flatMap(({value:e,text:t})=>[_(m.at(e),yc,m.at(e),s),g([m.at(e),s+16],t,{"text-anchor":`middle`})]),...h.ticks.flatMap(({value:e,text:t})=>[_(_c,h.at(e),hc-vc,h.at(e)),g([_c-6,h.at(e)+4],t,{"text-anchor":`end`})]),g([(_c+hc-vc)/2,s+36],a,{"text-anchor":`middle`}),g([16,v],l(e.unit)||`1`,{"text-anchor":`middle`,transform:`rotate(-90 16 ${pc(v)})`}),fc(`svg`,{x:_c,y:yc,width:hc-_c-vc,height:s-yc,viewBox:`${_c} ${yc} ${hc-_c-vc} ${s-yc}`},...e.lines.map(e=>kc(e,i,m,h))),fc(`rect`,{x:_c,y:yc,width:hc-_c-vc,height:s-yc,fill:`none`,stroke:r.rule}),...e.lines.map((e,t)=>{let[n,i]=[o.places[t][0],gc+o.places[t][1]];return Ac(e,n,i)+g([n+Cc+6,i+4],e.label,{fill:r.text})})))}function Oc({lines:e,part:t,logarithmic:n},r,i){let[a,o]=hs(e.map(({curve:e,marks:t})=>t??e),r,t,n)??wc;return n?Oe(S(a,o),i,yc):De(C(a,o),i,yc,6)}function kc({color:e,curve:t,marks:n,width:r,dash:i},a,o,s){let c=``,l=!1,u=[];for(let e=0;e<a.length;e++){let r=n?n[e]:t[e],[i,d]=[o.at(a[e]),s.at(r??NaN)];Number.isFinite(i+d)?n?u.push(fc(`circle`,{cx:i,cy:d,r:Ec})):(c+=`${l?`L`:`M`}${pc(i)} ${pc(d)}`,l=!0):l=!1}return n?fc(`g`,{fill:`none`,stroke:e,"stroke-width":1.5},...u):fc(`path`,{d:c,...jc(e,r,i)})}function Ac({color:e,marks:t,width:n,dash:r},i,a){return t?fc(`circle`,{cx:i+Cc/2,cy:a,r:Ec,fill:`none`,stroke:e,"stroke-width":1.5}):fc(`path`,{d:`M${pc(i)} ${pc(a)}h${Cc}`,...jc(e,n,r)})}function jc(e,t=1.8,n){return{fill:`none`,stroke:e,"stroke-width":t,"stroke-linejoin":`round`,"stroke-dasharray":n?.join(` `)}}function Mc(e){let[t,n]=[_c,4];return{places:e.map(({label:e})=>{let r=28+Sc*e.length+18;t>_c&&t+r>hc&&([t,n]=[_c,n+xc]);let i=[t,n];return t+=r,i}),height:e.length>0?n+xc:0}}function Nc(e,t){let n=document.createElement(`a`),r=URL.createObjectURL(e);n.href=r,n.download=Pc(t),n.click(),setTimeout(()=>URL.revokeObjectURL(r),6e4)}function Pc(e){return e.replace(/[^\p{L}\p{N}._]+/gu,`-`).replace(/^[-.]+|-+(?=\.|$)/g,``).slice(-120)||`hardpoint`}var Fc=2;function Ic(e,t,n){let{report:r}=e,a=r.file.replace(/\.[^.]*$/,``)||`report`,o=t.filter(({plot:e})=>e.canvas);return[...n?[{name:`View as PNG`,testId:`export-view-png`,run:async()=>Nc(await n.picture(Fc),`${a} view.png`)},{name:`View as SVG`,testId:`export-view-svg`,run:()=>Nc(n.vectors(),`${a} view.svg`)},{name:`Motion as glTF`,testId:`export-gltf`,run:async()=>Nc(await n.motion(),`${a}.glb`)}]:[],...o.flatMap(({plot:e})=>{let{title:t}=e.content;return[{name:`${t} as PNG`,testId:`export-plot-png`,run:async()=>Nc(await uc(e.canvas,t,{page:i(`--page`),text:i(`--ink`)}),`${a} ${t}.png`)},{name:`${t} as SVG`,testId:`export-plot-svg`,run:()=>Nc(Dc(e.content,r.times,r.units.time,Lc()),`${a} ${t}.svg`)}]}),...o.length>0?[{name:`Curves shown as CSV`,testId:`export-csv`,run:()=>Nc(ic(Rc(e,o)),`${a} curves.csv`)}]:[],{name:`Print or PDF`,testId:`export-print`,run:()=>print()}]}function Lc(){return{page:i(`--page`),text:i(`--ink`),muted:i(`--muted`),rule:i(`--rule`)}}function Rc({report:e},t){let n=t.map(({plot:e})=>e.content),r=new Map(n.flatMap(({over:e})=>e?[[e.label,e]]:[])),i=[{label:`time`,unit:e.units.time,curve:e.times},...[...r.values()].map(({label:e,unit:t,curve:n})=>({label:e,unit:t,curve:n})),...n.flatMap(({title:e,unit:t,lines:n})=>n.map(({label:n,curve:r})=>({label:n===e?n:`${e}: ${n}`,unit:t,curve:r})))],a=n.map(({over:t,part:n})=>n&&ms(t?.curve??e.times,n));return a.some(e=>!e)?i:i.map(e=>({...e,curve:e.curve.filter((e,t)=>a.some(e=>e.has(t)))}))}var zc=12;function Bc(t){let{report:n}=t,r=[...n.quantities.map(({name:e,group:n,index:r})=>({name:e,about:n,choose:()=>t.choose({quantity:r})})),...n.variables.map(({name:e,index:n})=>({name:e,about:`variable`,choose:()=>t.choose({variable:n})}))],i=[],a=0,o=e(`ul`,{class:`matches`,role:`listbox`,id:`matches`,hidden:!0}),s=e(`input`,{type:`search`,placeholder:`Find  /`,role:`combobox`,"aria-label":`Find a quantity or a variable`,"aria-controls":`matches`,"aria-expanded":`false`,"aria-autocomplete":`list`,autocomplete:`off`,"data-testid":`find`,oninput:()=>(a=0,u()),onfocus:()=>u(),onblur:()=>c(),onkeydown:e=>{let t={ArrowDown:1,ArrowUp:-1}[e.key];if(t&&i.length>0)a=(a+t+i.length)%i.length;else if(e.key===`Enter`)return l(i[a]);else if(e.key===`Escape`)return s.blur();else return;e.preventDefault(),u()}}),c=()=>{o.hidden=!0,s.setAttribute(`aria-expanded`,`false`),s.removeAttribute(`aria-activedescendant`)},l=e=>{e&&(e.choose(),s.value=``,s.blur())},u=()=>{let t=s.value.toLowerCase().split(/\s+/).filter(Boolean);i=t.length===0?[]:r.filter(({name:e})=>t.every(t=>e.toLowerCase().includes(t))).slice(0,zc),o.replaceChildren(...i.map((t,n)=>e(`li`,{role:`option`,id:`match-${n}`,"aria-selected":String(n===a),onpointerdown:e=>e.preventDefault(),onclick:()=>l(t)},e(`span`,{},t.name),e(`span`,{class:`muted`},t.about)))),t.length>0&&i.length===0&&o.replaceChildren(e(`li`,{class:`muted`},`nothing of that name`)),o.hidden=t.length===0,s.setAttribute(`aria-expanded`,String(!o.hidden)),i.length>0?s.setAttribute(`aria-activedescendant`,`match-${a}`):s.removeAttribute(`aria-activedescendant`)};return{element:e(`div`,{class:`find`},s,o),focus:()=>s.focus()}}var Vc=[[`Space`,`play or pause`],[`← →`,`one step back or forth`],[`Home End`,`first or last step`],[`F`,`fit the mechanism into the view`],[`L`,`names of hardpoints`],[`1 … 5`,`standard views, in the order of their buttons`],[`↑ ↓`,`another row of a list, when it has the focus`],[`+ − 0`,`in a plot: closer, further, the whole`],[`Shift ← →`,`in a plot: what is before or after`],[`drag`,`in a plot: the time; along its axis or with Shift: what is seen; double click: the whole`],[`/`,`find a quantity or a variable`],[`?`,`these keys`],[`Escape`,`close what is open, select nothing in the view`]],Hc=[[`solid`,`the present design`],[`dashed`,`the design that it is compared with`],[`dotted`,`foreseen to first or second order, or how far it may be off`],[`rings`,`finite differences of re-solved designs`]];function Uc(){let t=(t,n)=>e(`dl`,{class:`pairs`},...t.flatMap(([t,r])=>[e(`dt`,{},e(n,{},t)),e(`dd`,{},r)]));return e(`dialog`,{class:`help`,"data-testid":`keys`,"aria-label":`Keys and lines`},e(`h2`,{},`Keys`),t(Vc,`kbd`),e(`h2`,{},`Lines`),t(Hc,`span`),e(`form`,{method:`dialog`},e(`button`,{},`Close`)))}function Wc(e,t){document.addEventListener(`keydown`,n=>{let r=n.target;if(n.ctrlKey||n.metaKey||n.altKey||n.defaultPrevented||r.closest(`select, textarea, input:not([type=range]), [contenteditable=true], dialog, [role=menu]`))return;let i=Gc(n,r,e,t);i&&(n.preventDefault(),i())})}function Gc({key:e},t,n,r){let i=Number(e);if(e!==` `&&Number.isInteger(i)&&i>=1)return r.look&&(()=>r.look(i-1));switch(e){case` `:return t.closest(`button, summary`)?void 0:()=>n.toggle();case`f`:case`F`:return r.fit;case`l`:case`L`:return()=>n.choose({labels:!n.choice.labels});case`/`:return r.find;case`?`:return r.help;case`Escape`:return n.choice.selected?()=>n.choose({selected:void 0}):void 0}if(!t.closest(`input, [role=tablist]`))switch(e){case`ArrowLeft`:return()=>n.nudge(-1);case`ArrowRight`:return()=>n.nudge(1);case`Home`:return()=>n.nudge(-n.lastStep);case`End`:return()=>n.nudge(n.lastStep)}}function Kc(t,n){let r=t.map(({name:t},n)=>e(`button`,{type:`button`,"data-testid":`nav-${t}`,onclick:()=>i(n)},t)),i=e=>{t.forEach(({element:t},n)=>t.classList.toggle(`behind`,n!==e)),r.forEach((t,n)=>t.setAttribute(`aria-pressed`,String(n===e)))};i(0);let a=e(`button`,{type:`button`,class:`help-button`,"aria-label":`keys and lines`,"data-testid":`nav-help`,onclick:n},`?`);return e(`nav`,{class:`navigation`,"aria-label":`Sections`},...r,a)}var qc={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},Jc={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},Yc=1e3,Xc=1001,Zc=1002,Qc=1003,$c=1004,el=1005,tl=1006,nl=1007,rl=1008,il=1009,al=1010,ol=1011,sl=1012,cl=1013,ll=1014,ul=1015,dl=1016,fl=1017,pl=1018,ml=1020,hl=35902,gl=35899,_l=1021,vl=1022,yl=1023,bl=1026,xl=1027,Sl=1028,Cl=1029,wl=1030,Tl=1031,El=1033,Dl=33776,Ol=33777,kl=33778,Al=33779,jl=35840,Ml=35841,Nl=35842,Pl=35843,Fl=36196,Il=37492,Ll=37496,Rl=37488,zl=37489,Bl=37490,Vl=37491,Hl=37808,Ul=37809,Wl=37810,Gl=37811,Kl=37812,ql=37813,Jl=37814,Yl=37815,Xl=37816,Zl=37817,Ql=37818,$l=37819,eu=37820,tu=37821,nu=36492,ru=36494,iu=36495,au=36283,ou=36284,su=36285,cu=36286,lu=2300,uu=2301,du=2302,fu=2303,pu=2400,mu=2401,hu=2402,gu=2500,_u=3200,vu=`srgb`,yu=`srgb-linear`,bu=`linear`,xu=`srgb`,Su=7680,Cu=35044,wu=2e3;function Tu(e){for(let t=e.length-1;t>=0;--t)if(e[t]>=65535)return!0;return!1}function Eu(e){return ArrayBuffer.isView(e)&&!(e instanceof DataView)}function Du(e){return document.createElementNS(`http://www.w3.org/1999/xhtml`,e)}function Ou(){let e=Du(`canvas`);return e.style.display=`block`,e}var ku={};function Au(...e){let t=`THREE.`+e.shift();console.log(t,...e)}function ju(e){let t=e[0];if(typeof t==`string`&&t.startsWith(`TSL:`)){let t=e[1];t&&t.isStackTrace?e[0]+=` `+t.getLocation():e[1]=`Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.`}return e}function K(...e){e=ju(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.warn(n.getError(t)):console.warn(t,...e)}}function q(...e){e=ju(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.error(n.getError(t)):console.error(t,...e)}}function Mu(...e){let t=e.join(` `);t in ku||(ku[t]=!0,K(...e))}function Nu(e,t,n){return new Promise(function(r,i){function a(){switch(e.clientWaitSync(t,e.SYNC_FLUSH_COMMANDS_BIT,0)){case e.WAIT_FAILED:i();break;case e.TIMEOUT_EXPIRED:setTimeout(a,n);break;default:r()}}setTimeout(a,n)})}var Pu={0:0,2:6,4:4,3:5,1:1,6:2,7:7,5:3},Fu=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n!==void 0&&n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let r=n[e];if(r!==void 0){let e=r.indexOf(t);e!==-1&&r.splice(e,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let t=n.slice(0);for(let n=0,r=t.length;n<r;n++)t[n].call(this,e);e.target=null}}},Iu=`00.01.02.03.04.05.06.07.08.09.0a.0b.0c.0d.0e.0f.10.11.12.13.14.15.16.17.18.19.1a.1b.1c.1d.1e.1f.20.21.22.23.24.25.26.27.28.29.2a.2b.2c.2d.2e.2f.30.31.32.33.34.35.36.37.38.39.3a.3b.3c.3d.3e.3f.40.41.42.43.44.45.46.47.48.49.4a.4b.4c.4d.4e.4f.50.51.52.53.54.55.56.57.58.59.5a.5b.5c.5d.5e.5f.60.61.62.63.64.65.66.67.68.69.6a.6b.6c.6d.6e.6f.70.71.72.73.74.75.76.77.78.79.7a.7b.7c.7d.7e.7f.80.81.82.83.84.85.86.87.88.89.8a.8b.8c.8d.8e.8f.90.91.92.93.94.95.96.97.98.99.9a.9b.9c.9d.9e.9f.a0.a1.a2.a3.a4.a5.a6.a7.a8.a9.aa.ab.ac.ad.ae.af.b0.b1.b2.b3.b4.b5.b6.b7.b8.b9.ba.bb.bc.bd.be.bf.c0.c1.c2.c3.c4.c5.c6.c7.c8.c9.ca.cb.cc.cd.ce.cf.d0.d1.d2.d3.d4.d5.d6.d7.d8.d9.da.db.dc.dd.de.df.e0.e1.e2.e3.e4.e5.e6.e7.e8.e9.ea.eb.ec.ed.ee.ef.f0.f1.f2.f3.f4.f5.f6.f7.f8.f9.fa.fb.fc.fd.fe.ff`.split(`.`),Lu=1234567,Ru=Math.PI/180,zu=180/Math.PI;function Bu(){let e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0,r=Math.random()*4294967295|0;return(Iu[e&255]+Iu[e>>8&255]+Iu[e>>16&255]+Iu[e>>24&255]+`-`+Iu[t&255]+Iu[t>>8&255]+`-`+Iu[t>>16&15|64]+Iu[t>>24&255]+`-`+Iu[n&63|128]+Iu[n>>8&255]+`-`+Iu[n>>16&255]+Iu[n>>24&255]+Iu[r&255]+Iu[r>>8&255]+Iu[r>>16&255]+Iu[r>>24&255]).toLowerCase()}function J(e,t,n){return Math.max(t,Math.min(n,e))}function Vu(e,t){return(e%t+t)%t}function Hu(e,t,n,r,i){return r+(e-t)*(i-r)/(n-t)}function Uu(e,t,n){return e===t?0:(n-e)/(t-e)}function Wu(e,t,n){return(1-n)*e+n*t}function Gu(e,t,n,r){return Wu(e,t,1-Math.exp(-n*r))}function Ku(e,t=1){return t-Math.abs(Vu(e,t*2)-t)}function qu(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*(3-2*e))}function Ju(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*e*(e*(e*6-15)+10))}function Yu(e,t){return e+Math.floor(Math.random()*(t-e+1))}function Xu(e,t){return e+Math.random()*(t-e)}function Zu(e){return e*(.5-Math.random())}function Qu(e){e!==void 0&&(Lu=e);let t=Lu+=1831565813;return t=Math.imul(t^t>>>15,t|1),t^=t+Math.imul(t^t>>>7,t|61),((t^t>>>14)>>>0)/4294967296}function $u(e){return e*Ru}function ed(e){return e*zu}function td(e){return e>0&&Number.isInteger(e)&&2**Math.round(Math.log2(e))===e}function nd(e){return 2**Math.ceil(Math.log(e)/Math.LN2)}function rd(e){return 2**Math.floor(Math.log(e)/Math.LN2)}function id(e,t,n,r,i){let a=Math.cos,o=Math.sin,s=a(n/2),c=o(n/2),l=a((t+r)/2),u=o((t+r)/2),d=a((t-r)/2),f=o((t-r)/2),p=a((r-t)/2),m=o((r-t)/2);switch(i){case`XYX`:e.set(s*u,c*d,c*f,s*l);break;case`YZY`:e.set(c*f,s*u,c*d,s*l);break;case`ZXZ`:e.set(c*d,c*f,s*u,s*l);break;case`XZX`:e.set(s*u,c*m,c*p,s*l);break;case`YXY`:e.set(c*p,s*u,c*m,s*l);break;case`ZYZ`:e.set(c*m,c*p,s*u,s*l);break;default:K(`MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: `+i)}}function ad(e){switch(e.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function od(e,t){if(t.constructor===Float32Array)return e;let n=ad(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.max(e/n,-1)}function sd(e,t){if(t.constructor===Float32Array)return e;let n=ad(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.round(e*n)}var cd={DEG2RAD:Ru,RAD2DEG:zu,generateUUID:Bu,clamp:J,euclideanModulo:Vu,mapLinear:Hu,inverseLerp:Uu,lerp:Wu,damp:Gu,pingpong:Ku,smoothstep:qu,smootherstep:Ju,randInt:Yu,randFloat:Xu,randFloatSpread:Zu,seededRandom:Qu,degToRad:$u,radToDeg:ed,isPowerOfTwo:td,ceilPowerOfTwo:nd,floorPowerOfTwo:rd,setQuaternionFromProperEuler:id,normalize:sd,denormalize:od},Y=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw Error(`THREE.Vector2: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw Error(`THREE.Vector2: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6],this.y=r[1]*t+r[4]*n+r[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=J(this.x,e.x,t.x),this.y=J(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=J(this.x,e,t),this.y=J(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(J(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(J(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),r=Math.sin(t),i=this.x-e.x,a=this.y-e.y;return this.x=i*n-a*r+e.x,this.y=i*r+a*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},ld=class{constructor(e=0,t=0,n=0,r=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=r}static slerpFlat(e,t,n,r,i,a,o){let s=n[r+0],c=n[r+1],l=n[r+2],u=n[r+3],d=i[a+0],f=i[a+1],p=i[a+2],m=i[a+3];if(u!==m||s!==d||c!==f||l!==p){let e=s*d+c*f+l*p+u*m;e<0&&(d=-d,f=-f,p=-p,m=-m,e=-e);let t=1-o;if(e<.9995){let n=Math.acos(e),r=Math.sin(n);t=Math.sin(t*n)/r,o=Math.sin(o*n)/r,s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o}else{s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o;let e=1/Math.sqrt(s*s+c*c+l*l+u*u);s*=e,c*=e,l*=e,u*=e}}e[t]=s,e[t+1]=c,e[t+2]=l,e[t+3]=u}static multiplyQuaternionsFlat(e,t,n,r,i,a){let o=n[r],s=n[r+1],c=n[r+2],l=n[r+3],u=i[a],d=i[a+1],f=i[a+2],p=i[a+3];return e[t]=o*p+l*u+s*f-c*d,e[t+1]=s*p+l*d+c*u-o*f,e[t+2]=c*p+l*f+o*d-s*u,e[t+3]=l*p-o*u-s*d-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,r){return this._x=e,this._y=t,this._z=n,this._w=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,r=e._y,i=e._z,a=e._order,o=Math.cos,s=Math.sin,c=o(n/2),l=o(r/2),u=o(i/2),d=s(n/2),f=s(r/2),p=s(i/2);switch(a){case`XYZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`YXZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`ZXY`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`ZYX`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`YZX`:this._x=d*l*u+c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u-d*f*p;break;case`XZY`:this._x=d*l*u-c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u+d*f*p;break;default:K(`Quaternion: .setFromEuler() encountered an unknown order: `+a)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,r=Math.sin(n);return this._x=e.x*r,this._y=e.y*r,this._z=e.z*r,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],r=t[4],i=t[8],a=t[1],o=t[5],s=t[9],c=t[2],l=t[6],u=t[10],d=n+o+u;if(d>0){let e=.5/Math.sqrt(d+1);this._w=.25/e,this._x=(l-s)*e,this._y=(i-c)*e,this._z=(a-r)*e}else if(n>o&&n>u){let e=2*Math.sqrt(1+n-o-u);this._w=(l-s)/e,this._x=.25*e,this._y=(r+a)/e,this._z=(i+c)/e}else if(o>u){let e=2*Math.sqrt(1+o-n-u);this._w=(i-c)/e,this._x=(r+a)/e,this._y=.25*e,this._z=(s+l)/e}else{let e=2*Math.sqrt(1+u-n-o);this._w=(a-r)/e,this._x=(i+c)/e,this._y=(s+l)/e,this._z=.25*e}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(J(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let r=Math.min(1,t/n);return this.slerp(e,r),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x*=e,this._y*=e,this._z*=e,this._w*=e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=t._x,s=t._y,c=t._z,l=t._w;return this._x=n*l+a*o+r*c-i*s,this._y=r*l+a*s+i*o-n*c,this._z=i*l+a*c+n*s-r*o,this._w=a*l-n*o-r*s-i*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=this.dot(e);o<0&&(n=-n,r=-r,i=-i,a=-a,o=-o);let s=1-t;if(o<.9995){let e=Math.acos(o),c=Math.sin(e);s=Math.sin(s*e)/c,t=Math.sin(t*e)/c,this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this._onChangeCallback()}else this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),r=Math.sqrt(1-n),i=Math.sqrt(n);return this.set(r*Math.sin(e),r*Math.cos(e),i*Math.sin(t),i*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},X=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw Error(`THREE.Vector3: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw Error(`THREE.Vector3: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(dd.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(dd.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[3]*n+i[6]*r,this.y=i[1]*t+i[4]*n+i[7]*r,this.z=i[2]*t+i[5]*n+i[8]*r,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=e.elements,a=1/(i[3]*t+i[7]*n+i[11]*r+i[15]);return this.x=(i[0]*t+i[4]*n+i[8]*r+i[12])*a,this.y=(i[1]*t+i[5]*n+i[9]*r+i[13])*a,this.z=(i[2]*t+i[6]*n+i[10]*r+i[14])*a,this}applyQuaternion(e){let t=this.x,n=this.y,r=this.z,i=e.x,a=e.y,o=e.z,s=e.w,c=2*(a*r-o*n),l=2*(o*t-i*r),u=2*(i*n-a*t);return this.x=t+s*c+a*u-o*l,this.y=n+s*l+o*c-i*u,this.z=r+s*u+i*l-a*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[4]*n+i[8]*r,this.y=i[1]*t+i[5]*n+i[9]*r,this.z=i[2]*t+i[6]*n+i[10]*r,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=J(this.x,e.x,t.x),this.y=J(this.y,e.y,t.y),this.z=J(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=J(this.x,e,t),this.y=J(this.y,e,t),this.z=J(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(J(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,r=e.y,i=e.z,a=t.x,o=t.y,s=t.z;return this.x=r*s-i*o,this.y=i*a-n*s,this.z=n*o-r*a,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return ud.copy(this).projectOnVector(e),this.sub(ud)}reflect(e){return this.sub(ud.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(J(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,r=this.z-e.z;return t*t+n*n+r*r}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let r=Math.sin(t)*e;return this.x=r*Math.sin(n),this.y=Math.cos(t)*e,this.z=r*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),r=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=r,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},ud=new X,dd=new ld,fd=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,r,i,a,o,s,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c)}set(e,t,n,r,i,a,o,s,c){let l=this.elements;return l[0]=e,l[1]=r,l[2]=o,l[3]=t,l[4]=i,l[5]=s,l[6]=n,l[7]=a,l[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[3],s=n[6],c=n[1],l=n[4],u=n[7],d=n[2],f=n[5],p=n[8],m=r[0],h=r[3],g=r[6],_=r[1],v=r[4],y=r[7],b=r[2],x=r[5],S=r[8];return i[0]=a*m+o*_+s*b,i[3]=a*h+o*v+s*x,i[6]=a*g+o*y+s*S,i[1]=c*m+l*_+u*b,i[4]=c*h+l*v+u*x,i[7]=c*g+l*y+u*S,i[2]=d*m+f*_+p*b,i[5]=d*h+f*v+p*x,i[8]=d*g+f*y+p*S,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8];return t*a*l-t*o*c-n*i*l+n*o*s+r*i*c-r*a*s}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=l*a-o*c,d=o*s-l*i,f=c*i-a*s,p=t*u+n*d+r*f;if(p===0)return this.set(0,0,0,0,0,0,0,0,0);let m=1/p;return e[0]=u*m,e[1]=(r*c-l*n)*m,e[2]=(o*n-r*a)*m,e[3]=d*m,e[4]=(l*t-r*s)*m,e[5]=(r*i-o*t)*m,e[6]=f*m,e[7]=(n*s-c*t)*m,e[8]=(a*t-n*i)*m,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,r,i,a,o){let s=Math.cos(i),c=Math.sin(i);return this.set(n*s,n*c,-n*(s*a+c*o)+a+e,-r*c,r*s,-r*(-c*a+s*o)+o+t,0,0,1),this}scale(e,t){return Mu(`Matrix3: .scale() is deprecated. Use .makeScale() instead.`),this.premultiply(pd.makeScale(e,t)),this}rotate(e){return Mu(`Matrix3: .rotate() is deprecated. Use .makeRotation() instead.`),this.premultiply(pd.makeRotation(-e)),this}translate(e,t){return Mu(`Matrix3: .translate() is deprecated. Use .makeTranslation() instead.`),this.premultiply(pd.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<9;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},pd=new fd,md=new fd().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),hd=new fd().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function gd(){let e={enabled:!0,workingColorSpace:yu,spaces:{},convert:function(e,t,n){return this.enabled===!1||t===n||!t||!n||(this.spaces[t].transfer===`srgb`&&(e.r=vd(e.r),e.g=vd(e.g),e.b=vd(e.b)),this.spaces[t].primaries!==this.spaces[n].primaries&&(e.applyMatrix3(this.spaces[t].toXYZ),e.applyMatrix3(this.spaces[n].fromXYZ)),this.spaces[n].transfer===`srgb`&&(e.r=yd(e.r),e.g=yd(e.g),e.b=yd(e.b))),e},workingToColorSpace:function(e,t){return this.convert(e,this.workingColorSpace,t)},colorSpaceToWorking:function(e,t){return this.convert(e,t,this.workingColorSpace)},getPrimaries:function(e){return this.spaces[e].primaries},getTransfer:function(e){return e===``?bu:this.spaces[e].transfer},getToneMappingMode:function(e){return this.spaces[e].outputColorSpaceConfig.toneMappingMode||`standard`},getLuminanceCoefficients:function(e,t=this.workingColorSpace){return e.fromArray(this.spaces[t].luminanceCoefficients)},define:function(e){Object.assign(this.spaces,e)},_getMatrix:function(e,t,n){return e.copy(this.spaces[n].fromXYZ).multiply(this.spaces[t].toXYZ)},_getDrawingBufferColorSpace:function(e){return this.spaces[e].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(e=this.workingColorSpace){return this.spaces[e].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],n=[.2126,.7152,.0722],r=[.3127,.329];return e.define({[yu]:{primaries:t,whitePoint:r,transfer:bu,toXYZ:md,fromXYZ:hd,luminanceCoefficients:n,workingColorSpaceConfig:{unpackColorSpace:vu},outputColorSpaceConfig:{drawingBufferColorSpace:vu}},[vu]:{primaries:t,whitePoint:r,transfer:xu,toXYZ:md,fromXYZ:hd,luminanceCoefficients:n,outputColorSpaceConfig:{drawingBufferColorSpace:vu}}}),e}var _d=gd();function vd(e){return e<.04045?e*.0773993808:(e*.9478672986+.0521327014)**2.4}function yd(e){return e<.0031308?e*12.92:1.055*e**.41666-.055}var bd,xd=class{static getDataURL(e,t=`image/png`){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>`u`)return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{bd===void 0&&(bd=Du(`canvas`)),bd.width=e.width,bd.height=e.height;let t=bd.getContext(`2d`);e instanceof ImageData?t.putImageData(e,0,0):t.drawImage(e,0,0,e.width,e.height),n=bd}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap){let t=Du(`canvas`);t.width=e.width,t.height=e.height;let n=t.getContext(`2d`);n.drawImage(e,0,0,e.width,e.height);let r=n.getImageData(0,0,e.width,e.height),i=r.data;for(let e=0;e<i.length;e++)i[e]=vd(i[e]/255)*255;return n.putImageData(r,0,0),t}if(e.data){let t=e.data.slice(0);for(let e=0;e<t.length;e++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[e]=Math.floor(vd(t[e]/255)*255):t[e]=vd(t[e]);return{data:t,width:e.width,height:e.height}}return K(`ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied.`),e}},Sd=0,Cd=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:Sd++}),this.uuid=Bu(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<`u`&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<`u`&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t===null?e.set(0,0,0):e.set(t.width||0,t.height||0,t.depth||0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:``},r=this.data;if(r!==null){let e;if(Array.isArray(r)){e=[];for(let t=0,n=r.length;t<n;t++)r[t].isDataTexture?e.push(wd(r[t].image)):e.push(wd(r[t]))}else e=wd(r);n.url=e}return t||(e.images[this.uuid]=n),n}};function wd(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap?xd.getDataURL(e):e.data?{data:Array.from(e.data),width:e.width,height:e.height,type:e.data.constructor.name}:(K(`Texture: Unable to serialize Texture.`),{})}var Td=0,Ed=new X,Dd=class e extends Fu{constructor(t=e.DEFAULT_IMAGE,n=e.DEFAULT_MAPPING,r=Xc,i=Xc,a=tl,o=rl,s=yl,c=il,l=e.DEFAULT_ANISOTROPY,u=``){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Td++}),this.uuid=Bu(),this.name=``,this.source=new Cd(t),this.mipmaps=[],this.mapping=n,this.channel=0,this.wrapS=r,this.wrapT=i,this.magFilter=a,this.minFilter=o,this.anisotropy=l,this.format=s,this.internalFormat=null,this.type=c,this.offset=new Y(0,0),this.repeat=new Y(1,1),this.center=new Y(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new fd,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(t&&t.depth&&t.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Ed).x}get height(){return this.source.getSize(Ed).y}get depth(){return this.source.getSize(Ed).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){K(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?K(`Texture.setValues(): property '${t}' does not exist.`):r&&n&&r.isVector2&&n.isVector2||r&&n&&r.isVector3&&n.isVector3||r&&n&&r.isMatrix3&&n.isMatrix3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:`Texture`,generator:`Texture.toJSON`},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:`dispose`})}transformUv(e){if(this.mapping!==300)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Yc:e.x-=Math.floor(e.x);break;case Xc:e.x=e.x<0?0:1;break;case Zc:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x-=Math.floor(e.x)}if(e.y<0||e.y>1)switch(this.wrapT){case Yc:e.y-=Math.floor(e.y);break;case Xc:e.y=e.y<0?0:1;break;case Zc:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y-=Math.floor(e.y)}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};Dd.DEFAULT_IMAGE=null,Dd.DEFAULT_MAPPING=300,Dd.DEFAULT_ANISOTROPY=1;var Od=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,r=1){this.x=e,this.y=t,this.z=n,this.w=r}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,r){return this.x=e,this.y=t,this.z=n,this.w=r,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw Error(`THREE.Vector4: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw Error(`THREE.Vector4: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w===void 0?1:e.w,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=this.w,a=e.elements;return this.x=a[0]*t+a[4]*n+a[8]*r+a[12]*i,this.y=a[1]*t+a[5]*n+a[9]*r+a[13]*i,this.z=a[2]*t+a[6]*n+a[10]*r+a[14]*i,this.w=a[3]*t+a[7]*n+a[11]*r+a[15]*i,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,r,i,a=.01,o=.1,s=e.elements,c=s[0],l=s[4],u=s[8],d=s[1],f=s[5],p=s[9],m=s[2],h=s[6],g=s[10];if(Math.abs(l-d)<a&&Math.abs(u-m)<a&&Math.abs(p-h)<a){if(Math.abs(l+d)<o&&Math.abs(u+m)<o&&Math.abs(p+h)<o&&Math.abs(c+f+g-3)<o)return this.set(1,0,0,0),this;t=Math.PI;let e=(c+1)/2,s=(f+1)/2,_=(g+1)/2,v=(l+d)/4,y=(u+m)/4,b=(p+h)/4;return e>s&&e>_?e<a?(n=0,r=.707106781,i=.707106781):(n=Math.sqrt(e),r=v/n,i=y/n):s>_?s<a?(n=.707106781,r=0,i=.707106781):(r=Math.sqrt(s),n=v/r,i=b/r):_<a?(n=.707106781,r=.707106781,i=0):(i=Math.sqrt(_),n=y/i,r=b/i),this.set(n,r,i,t),this}let _=Math.sqrt((h-p)*(h-p)+(u-m)*(u-m)+(d-l)*(d-l));return Math.abs(_)<.001&&(_=1),this.x=(h-p)/_,this.y=(u-m)/_,this.z=(d-l)/_,this.w=Math.acos((c+f+g-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=J(this.x,e.x,t.x),this.y=J(this.y,e.y,t.y),this.z=J(this.z,e.z,t.z),this.w=J(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=J(this.x,e,t),this.y=J(this.y,e,t),this.z=J(this.z,e,t),this.w=J(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(J(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},kd=class extends Fu{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:tl,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new Od(0,0,e,t),this.scissorTest=!1,this.viewport=new Od(0,0,e,t),this.textures=[];let r=n.count;for(let i=0;i<r;i++)this.textures[i]=new Dd({width:e,height:t,depth:n.depth}),this.textures[i].isRenderTargetTexture=!0,this.textures[i].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:tl,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let e=0;e<this.textures.length;e++)this.textures[e].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let r=0,i=this.textures.length;r<i;r++)this.textures[r].image.width=e,this.textures[r].image.height=t,this.textures[r].image.depth=n,this.textures[r].isData3DTexture!==!0&&(this.textures[r].isArrayTexture=this.textures[r].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let n=Object.assign({},e.textures[t].image);this.textures[t].source=new Cd(n)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null){if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture}else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:`dispose`})}},Ad=class extends kd{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},jd=class extends Dd{constructor(e=null,t=1,n=1,r=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=Qc,this.minFilter=Qc,this.wrapR=Xc,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}},Md=class extends Dd{constructor(e=null,t=1,n=1,r=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=Qc,this.minFilter=Qc,this.wrapR=Xc,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}},Nd=class e{static{this.prototype.isMatrix4=!0}constructor(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h)}set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){let g=this.elements;return g[0]=e,g[4]=t,g[8]=n,g[12]=r,g[1]=i,g[5]=a,g[9]=o,g[13]=s,g[2]=c,g[6]=l,g[10]=u,g[14]=d,g[3]=f,g[7]=p,g[11]=m,g[15]=h,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new e().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,r=1/Pd.setFromMatrixColumn(e,0).length(),i=1/Pd.setFromMatrixColumn(e,1).length(),a=1/Pd.setFromMatrixColumn(e,2).length();return t[0]=n[0]*r,t[1]=n[1]*r,t[2]=n[2]*r,t[3]=0,t[4]=n[4]*i,t[5]=n[5]*i,t[6]=n[6]*i,t[7]=0,t[8]=n[8]*a,t[9]=n[9]*a,t[10]=n[10]*a,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,r=e.y,i=e.z,a=Math.cos(n),o=Math.sin(n),s=Math.cos(r),c=Math.sin(r),l=Math.cos(i),u=Math.sin(i);if(e.order===`XYZ`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=-s*u,t[8]=c,t[1]=n+r*c,t[5]=e-i*c,t[9]=-o*s,t[2]=i-e*c,t[6]=r+n*c,t[10]=a*s}else if(e.order===`YXZ`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e+i*o,t[4]=r*o-n,t[8]=a*c,t[1]=a*u,t[5]=a*l,t[9]=-o,t[2]=n*o-r,t[6]=i+e*o,t[10]=a*s}else if(e.order===`ZXY`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e-i*o,t[4]=-a*u,t[8]=r+n*o,t[1]=n+r*o,t[5]=a*l,t[9]=i-e*o,t[2]=-a*c,t[6]=o,t[10]=a*s}else if(e.order===`ZYX`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=r*c-n,t[8]=e*c+i,t[1]=s*u,t[5]=i*c+e,t[9]=n*c-r,t[2]=-c,t[6]=o*s,t[10]=a*s}else if(e.order===`YZX`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=i-e*u,t[8]=r*u+n,t[1]=u,t[5]=a*l,t[9]=-o*l,t[2]=-c*l,t[6]=n*u+r,t[10]=e-i*u}else if(e.order===`XZY`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=-u,t[8]=c*l,t[1]=e*u+i,t[5]=a*l,t[9]=n*u-r,t[2]=r*u-n,t[6]=o*l,t[10]=i*u+e}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(Id,e,Ld)}lookAt(e,t,n){let r=this.elements;return Bd.subVectors(e,t),Bd.lengthSq()===0&&(Bd.z=1),Bd.normalize(),Rd.crossVectors(n,Bd),Rd.lengthSq()===0&&(Math.abs(n.z)===1?Bd.x+=1e-4:Bd.z+=1e-4,Bd.normalize(),Rd.crossVectors(n,Bd)),Rd.normalize(),zd.crossVectors(Bd,Rd),r[0]=Rd.x,r[4]=zd.x,r[8]=Bd.x,r[1]=Rd.y,r[5]=zd.y,r[9]=Bd.y,r[2]=Rd.z,r[6]=zd.z,r[10]=Bd.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[4],s=n[8],c=n[12],l=n[1],u=n[5],d=n[9],f=n[13],p=n[2],m=n[6],h=n[10],g=n[14],_=n[3],v=n[7],y=n[11],b=n[15],x=r[0],S=r[4],C=r[8],w=r[12],T=r[1],E=r[5],D=r[9],O=r[13],k=r[2],A=r[6],j=r[10],M=r[14],N=r[3],ee=r[7],te=r[11],ne=r[15];return i[0]=a*x+o*T+s*k+c*N,i[4]=a*S+o*E+s*A+c*ee,i[8]=a*C+o*D+s*j+c*te,i[12]=a*w+o*O+s*M+c*ne,i[1]=l*x+u*T+d*k+f*N,i[5]=l*S+u*E+d*A+f*ee,i[9]=l*C+u*D+d*j+f*te,i[13]=l*w+u*O+d*M+f*ne,i[2]=p*x+m*T+h*k+g*N,i[6]=p*S+m*E+h*A+g*ee,i[10]=p*C+m*D+h*j+g*te,i[14]=p*w+m*O+h*M+g*ne,i[3]=_*x+v*T+y*k+b*N,i[7]=_*S+v*E+y*A+b*ee,i[11]=_*C+v*D+y*j+b*te,i[15]=_*w+v*O+y*M+b*ne,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[12],a=e[1],o=e[5],s=e[9],c=e[13],l=e[2],u=e[6],d=e[10],f=e[14],p=e[3],m=e[7],h=e[11],g=e[15],_=s*f-c*d,v=o*f-c*u,y=o*d-s*u,b=a*f-c*l,x=a*d-s*l,S=a*u-o*l;return t*(m*_-h*v+g*y)-n*(p*_-h*b+g*x)+r*(p*v-m*b+g*S)-i*(p*y-m*x+h*S)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[1],a=e[5],o=e[9],s=e[2],c=e[6],l=e[10];return t*(a*l-o*c)-n*(i*l-o*s)+r*(i*c-a*s)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let r=this.elements;return e.isVector3?(r[12]=e.x,r[13]=e.y,r[14]=e.z):(r[12]=e,r[13]=t,r[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=e[9],d=e[10],f=e[11],p=e[12],m=e[13],h=e[14],g=e[15],_=t*o-n*a,v=t*s-r*a,y=t*c-i*a,b=n*s-r*o,x=n*c-i*o,S=r*c-i*s,C=l*m-u*p,w=l*h-d*p,T=l*g-f*p,E=u*h-d*m,D=u*g-f*m,O=d*g-f*h,k=_*O-v*D+y*E+b*T-x*w+S*C;if(k===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let A=1/k;return e[0]=(o*O-s*D+c*E)*A,e[1]=(r*D-n*O-i*E)*A,e[2]=(m*S-h*x+g*b)*A,e[3]=(d*x-u*S-f*b)*A,e[4]=(s*T-a*O-c*w)*A,e[5]=(t*O-r*T+i*w)*A,e[6]=(h*y-p*S-g*v)*A,e[7]=(l*S-d*y+f*v)*A,e[8]=(a*D-o*T+c*C)*A,e[9]=(n*T-t*D-i*C)*A,e[10]=(p*x-m*y+g*_)*A,e[11]=(u*y-l*x-f*_)*A,e[12]=(o*w-a*E-s*C)*A,e[13]=(t*E-n*w+r*C)*A,e[14]=(m*v-p*b-h*_)*A,e[15]=(l*b-u*v+d*_)*A,this}scale(e){let t=this.elements,n=e.x,r=e.y,i=e.z;return t[0]*=n,t[4]*=r,t[8]*=i,t[1]*=n,t[5]*=r,t[9]*=i,t[2]*=n,t[6]*=r,t[10]*=i,t[3]*=n,t[7]*=r,t[11]*=i,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],r=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,r))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),r=Math.sin(t),i=1-n,a=e.x,o=e.y,s=e.z,c=i*a,l=i*o;return this.set(c*a+n,c*o-r*s,c*s+r*o,0,c*o+r*s,l*o+n,l*s-r*a,0,c*s-r*o,l*s+r*a,i*s*s+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,r,i,a){return this.set(1,n,i,0,e,1,a,0,t,r,1,0,0,0,0,1),this}compose(e,t,n){let r=this.elements,i=t._x,a=t._y,o=t._z,s=t._w,c=i+i,l=a+a,u=o+o,d=i*c,f=i*l,p=i*u,m=a*l,h=a*u,g=o*u,_=s*c,v=s*l,y=s*u,b=n.x,x=n.y,S=n.z;return r[0]=(1-(m+g))*b,r[1]=(f+y)*b,r[2]=(p-v)*b,r[3]=0,r[4]=(f-y)*x,r[5]=(1-(d+g))*x,r[6]=(h+_)*x,r[7]=0,r[8]=(p+v)*S,r[9]=(h-_)*S,r[10]=(1-(d+m))*S,r[11]=0,r[12]=e.x,r[13]=e.y,r[14]=e.z,r[15]=1,this}decompose(e,t,n){let r=this.elements;e.x=r[12],e.y=r[13],e.z=r[14];let i=this.determinantAffine();if(i===0)return n.set(1,1,1),t.identity(),this;let a=Pd.set(r[0],r[1],r[2]).length(),o=Pd.set(r[4],r[5],r[6]).length(),s=Pd.set(r[8],r[9],r[10]).length();i<0&&(a=-a),Fd.copy(this);let c=1/a,l=1/o,u=1/s;return Fd.elements[0]*=c,Fd.elements[1]*=c,Fd.elements[2]*=c,Fd.elements[4]*=l,Fd.elements[5]*=l,Fd.elements[6]*=l,Fd.elements[8]*=u,Fd.elements[9]*=u,Fd.elements[10]*=u,t.setFromRotationMatrix(Fd),n.x=a,n.y=o,n.z=s,this}makePerspective(e,t,n,r,i,a,o=wu,s=!1){let c=this.elements,l=2*i/(t-e),u=2*i/(n-r),d=(t+e)/(t-e),f=(n+r)/(n-r),p,m;if(s)p=i/(a-i),m=a*i/(a-i);else if(o===2e3)p=-(a+i)/(a-i),m=-2*a*i/(a-i);else if(o===2001)p=-a/(a-i),m=-a*i/(a-i);else throw Error(`THREE.Matrix4.makePerspective(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=d,c[12]=0,c[1]=0,c[5]=u,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,r,i,a,o=wu,s=!1){let c=this.elements,l=2/(t-e),u=2/(n-r),d=-(t+e)/(t-e),f=-(n+r)/(n-r),p,m;if(s)p=1/(a-i),m=a/(a-i);else if(o===2e3)p=-2/(a-i),m=-(a+i)/(a-i);else if(o===2001)p=-1/(a-i),m=-i/(a-i);else throw Error(`THREE.Matrix4.makeOrthographic(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=0,c[12]=d,c[1]=0,c[5]=u,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<16;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},Pd=new X,Fd=new Nd,Id=new X(0,0,0),Ld=new X(1,1,1),Rd=new X,zd=new X,Bd=new X,Vd=new Nd,Hd=new ld,Ud=class e{constructor(t=0,n=0,r=0,i=e.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=n,this._z=r,this._order=i}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,r=this._order){return this._x=e,this._y=t,this._z=n,this._order=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let r=e.elements,i=r[0],a=r[4],o=r[8],s=r[1],c=r[5],l=r[9],u=r[2],d=r[6],f=r[10];switch(t){case`XYZ`:this._y=Math.asin(J(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-l,f),this._z=Math.atan2(-a,i)):(this._x=Math.atan2(d,c),this._z=0);break;case`YXZ`:this._x=Math.asin(-J(l,-1,1)),Math.abs(l)<.9999999?(this._y=Math.atan2(o,f),this._z=Math.atan2(s,c)):(this._y=Math.atan2(-u,i),this._z=0);break;case`ZXY`:this._x=Math.asin(J(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(-u,f),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(s,i));break;case`ZYX`:this._y=Math.asin(-J(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(d,f),this._z=Math.atan2(s,i)):(this._x=0,this._z=Math.atan2(-a,c));break;case`YZX`:this._z=Math.asin(J(s,-1,1)),Math.abs(s)<.9999999?(this._x=Math.atan2(-l,c),this._y=Math.atan2(-u,i)):(this._x=0,this._y=Math.atan2(o,f));break;case`XZY`:this._z=Math.asin(-J(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(d,c),this._y=Math.atan2(o,i)):(this._x=Math.atan2(-l,f),this._y=0);break;default:K(`Euler: .setFromRotationMatrix() encountered an unknown order: `+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return Vd.makeRotationFromQuaternion(e),this.setFromRotationMatrix(Vd,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return Hd.setFromEuler(this),this.setFromQuaternion(Hd,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Ud.DEFAULT_ORDER=`XYZ`;var Wd=class{constructor(){this.mask=1}set(e){this.mask=1<<e>>>0}enable(e){this.mask|=1<<e}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e}disable(e){this.mask&=~(1<<e)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return!!(this.mask&1<<e)}},Gd=0,Kd=new X,qd=new ld,Jd=new Nd,Yd=new X,Xd=new X,Zd=new X,Qd=new ld,$d=new X(1,0,0),ef=new X(0,1,0),tf=new X(0,0,1),nf={type:`added`},rf={type:`removed`},af={type:`childadded`,child:null},of={type:`childremoved`,child:null},sf=class e extends Fu{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Gd++}),this.uuid=Bu(),this.name=``,this.type=`Object3D`,this.parent=null,this.children=[],this.up=e.DEFAULT_UP.clone();let t=new X,n=new Ud,r=new ld,i=new X(1,1,1);function a(){r.setFromEuler(n,!1)}function o(){n.setFromQuaternion(r,void 0,!1)}n._onChange(a),r._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:n},quaternion:{configurable:!0,enumerable:!0,value:r},scale:{configurable:!0,enumerable:!0,value:i},modelViewMatrix:{value:new Nd},normalMatrix:{value:new fd}}),this.matrix=new Nd,this.matrixWorld=new Nd,this.matrixAutoUpdate=e.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=e.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Wd,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return qd.setFromAxisAngle(e,t),this.quaternion.multiply(qd),this}rotateOnWorldAxis(e,t){return qd.setFromAxisAngle(e,t),this.quaternion.premultiply(qd),this}rotateX(e){return this.rotateOnAxis($d,e)}rotateY(e){return this.rotateOnAxis(ef,e)}rotateZ(e){return this.rotateOnAxis(tf,e)}translateOnAxis(e,t){return Kd.copy(e).applyQuaternion(this.quaternion),this.position.add(Kd.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis($d,e)}translateY(e){return this.translateOnAxis(ef,e)}translateZ(e){return this.translateOnAxis(tf,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(Jd.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?Yd.copy(e):Yd.set(e,t,n);let r=this.parent;this.updateWorldMatrix(!0,!1),Xd.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Jd.lookAt(Xd,Yd,this.up):Jd.lookAt(Yd,Xd,this.up),this.quaternion.setFromRotationMatrix(Jd),r&&(Jd.extractRotation(r.matrixWorld),qd.setFromRotationMatrix(Jd),this.quaternion.premultiply(qd.invert()))}add(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return e===this?(q(`Object3D.add: object can't be added as a child of itself.`,e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(nf),af.child=e,this.dispatchEvent(af),af.child=null):q(`Object3D.add: object not an instance of THREE.Object3D.`,e),this)}remove(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.remove(arguments[e]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(rf),of.child=e,this.dispatchEvent(of),of.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),Jd.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),Jd.multiply(e.parent.matrixWorld)),e.applyMatrix4(Jd),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(nf),af.child=e,this.dispatchEvent(af),af.child=null,this}getObjectById(e){return this.getObjectByProperty(`id`,e)}getObjectByName(e){return this.getObjectByProperty(`name`,e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,r=this.children.length;n<r;n++){let r=this.children[n].getObjectByProperty(e,t);if(r!==void 0)return r}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let r=this.children;for(let i=0,a=r.length;i<a;i++)r[i].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Xd,e,Zd),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Xd,Qd,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,r=e.z,i=this.matrix.elements;i[12]+=t-i[0]*t-i[4]*n-i[8]*r,i[13]+=n-i[1]*t-i[5]*n-i[9]*r,i[14]+=r-i[2]*t-i[6]*n-i[10]*r}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let r=this.parent;if(e===!0&&r!==null&&r.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let e=this.children;for(let t=0,r=e.length;t<r;t++)e[t].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e==`string`,n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:`Object`,generator:`Object3D.toJSON`});let r={};r.uuid=this.uuid,r.type=this.type,r.name=this.name,r.castShadow=this.castShadow,r.receiveShadow=this.receiveShadow,r.visible=this.visible,r.frustumCulled=this.frustumCulled,r.renderOrder=this.renderOrder,r.static=this.static,r.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(r.userData=this.userData),r.layers=this.layers.mask,r.matrix=this.matrix.toArray(),r.up=this.up.toArray(),this.pivot!==null&&(r.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(r.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(r.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(r.type=`InstancedMesh`,r.count=this.count,r.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(r.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(r.type=`BatchedMesh`,r.perObjectFrustumCulled=this.perObjectFrustumCulled,r.sortObjects=this.sortObjects,r.drawRanges=this._drawRanges,r.reservedRanges=this._reservedRanges,r.geometryInfo=this._geometryInfo.map(e=>({...e,boundingBox:e.boundingBox?e.boundingBox.toJSON():void 0,boundingSphere:e.boundingSphere?e.boundingSphere.toJSON():void 0})),r.instanceInfo=this._instanceInfo.map(e=>({...e})),r.availableInstanceIds=this._availableInstanceIds.slice(),r.availableGeometryIds=this._availableGeometryIds.slice(),r.nextIndexStart=this._nextIndexStart,r.nextVertexStart=this._nextVertexStart,r.geometryCount=this._geometryCount,r.maxInstanceCount=this._maxInstanceCount,r.maxVertexCount=this._maxVertexCount,r.maxIndexCount=this._maxIndexCount,r.geometryInitialized=this._geometryInitialized,r.matricesTexture=this._matricesTexture.toJSON(e),r.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(r.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(r.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(r.boundingBox=this.boundingBox.toJSON()));function i(t,n){return t[n.uuid]===void 0&&(t[n.uuid]=n.toJSON(e)),n.uuid}if(this.isScene)this.background&&(this.background.isColor?r.background=this.background.toJSON():this.background.isTexture&&(r.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(r.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){r.geometry=i(e.geometries,this.geometry);let t=this.geometry.parameters;if(t!==void 0&&t.shapes!==void 0){let n=t.shapes;if(Array.isArray(n))for(let t=0,r=n.length;t<r;t++){let r=n[t];i(e.shapes,r)}else i(e.shapes,n)}}if(this.isSkinnedMesh&&(r.bindMode=this.bindMode,r.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(i(e.skeletons,this.skeleton),r.skeleton=this.skeleton.uuid)),this.material!==void 0){if(Array.isArray(this.material)){let t=[];for(let n=0,r=this.material.length;n<r;n++)t.push(i(e.materials,this.material[n]));r.material=t}else r.material=i(e.materials,this.material)}if(this.children.length>0){r.children=[];for(let t=0;t<this.children.length;t++)r.children.push(this.children[t].toJSON(e).object)}if(this.animations.length>0){r.animations=[];for(let t=0;t<this.animations.length;t++){let n=this.animations[t];r.animations.push(i(e.animations,n))}}if(t){let t=a(e.geometries),r=a(e.materials),i=a(e.textures),o=a(e.images),s=a(e.shapes),c=a(e.skeletons),l=a(e.animations),u=a(e.nodes);t.length>0&&(n.geometries=t),r.length>0&&(n.materials=r),i.length>0&&(n.textures=i),o.length>0&&(n.images=o),s.length>0&&(n.shapes=s),c.length>0&&(n.skeletons=c),l.length>0&&(n.animations=l),u.length>0&&(n.nodes=u)}return n.object=r,n;function a(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot===null?null:e.pivot.clone(),this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let t=0;t<e.children.length;t++){let n=e.children[t];this.add(n.clone())}return this}dispose(){this.dispatchEvent({type:`dispose`})}};sf.DEFAULT_UP=new X(0,1,0),sf.DEFAULT_MATRIX_AUTO_UPDATE=!0,sf.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var cf=class extends sf{constructor(){super(),this.isGroup=!0,this.type=`Group`}},lf={type:`move`},uf=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new cf,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new cf,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new X,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new X),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new cf,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new X,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new X,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:`connected`,data:e}),this}disconnect(e){return this.dispatchEvent({type:`disconnected`,data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let r=null,i=null,a=null,o=this._targetRay,s=this._grip,c=this._hand;if(e&&t.session.visibilityState!==`visible-blurred`){if(c&&e.hand){a=!0;for(let r of e.hand.values()){let e=t.getJointPose(r,n),i=this._getHandJoint(c,r);e!==null&&(i.matrix.fromArray(e.transform.matrix),i.matrix.decompose(i.position,i.quaternion,i.scale),i.matrixWorldNeedsUpdate=!0,i.jointRadius=e.radius),i.visible=e!==null}let r=c.joints[`index-finger-tip`],i=c.joints[`thumb-tip`],o=r.position.distanceTo(i.position);c.inputState.pinching&&o>.025?(c.inputState.pinching=!1,this.dispatchEvent({type:`pinchend`,handedness:e.handedness,target:this})):!c.inputState.pinching&&o<=.015&&(c.inputState.pinching=!0,this.dispatchEvent({type:`pinchstart`,handedness:e.handedness,target:this}))}else s!==null&&e.gripSpace&&(i=t.getPose(e.gripSpace,n),i!==null&&(s.matrix.fromArray(i.transform.matrix),s.matrix.decompose(s.position,s.quaternion,s.scale),s.matrixWorldNeedsUpdate=!0,i.linearVelocity?(s.hasLinearVelocity=!0,s.linearVelocity.copy(i.linearVelocity)):s.hasLinearVelocity=!1,i.angularVelocity?(s.hasAngularVelocity=!0,s.angularVelocity.copy(i.angularVelocity)):s.hasAngularVelocity=!1,s.eventsEnabled&&s.dispatchEvent({type:`gripUpdated`,data:e,target:this})));o!==null&&(r=t.getPose(e.targetRaySpace,n),r===null&&i!==null&&(r=i),r!==null&&(o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,r.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(r.linearVelocity)):o.hasLinearVelocity=!1,r.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(r.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent(lf)))}return o!==null&&(o.visible=r!==null),s!==null&&(s.visible=i!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new cf;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},df={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},ff={h:0,s:0,l:0},pf={h:0,s:0,l:0};function mf(e,t,n){return n<0&&(n+=1),n>1&&--n,n<1/6?e+(t-e)*6*n:n<1/2?t:n<2/3?e+(t-e)*6*(2/3-n):e}var Z=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let t=e;t&&t.isColor?this.copy(t):typeof t==`number`?this.setHex(t):typeof t==`string`&&this.setStyle(t)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=vu){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,_d.colorSpaceToWorking(this,t),this}setRGB(e,t,n,r=_d.workingColorSpace){return this.r=e,this.g=t,this.b=n,_d.colorSpaceToWorking(this,r),this}setHSL(e,t,n,r=_d.workingColorSpace){if(e=Vu(e,1),t=J(t,0,1),n=J(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,i=2*n-r;this.r=mf(i,r,e+1/3),this.g=mf(i,r,e),this.b=mf(i,r,e-1/3)}return _d.colorSpaceToWorking(this,r),this}setStyle(e,t=vu){function n(t){t!==void 0&&parseFloat(t)<1&&K(`Color: Alpha component of `+e+` will be ignored.`)}let r;if(r=/^(\w+)\(([^\)]*)\)/.exec(e)){let i,a=r[1],o=r[2];switch(a){case`rgb`:case`rgba`:if(i=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(255,parseInt(i[1],10))/255,Math.min(255,parseInt(i[2],10))/255,Math.min(255,parseInt(i[3],10))/255,t);if(i=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(100,parseFloat(i[1]))/100,Math.min(100,parseFloat(i[2]))/100,Math.min(100,parseFloat(i[3]))/100,t);break;case`hsl`:case`hsla`:if(i=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setHSL(parseFloat(i[1])/360,parseFloat(i[2])/100,parseFloat(i[3])/100,t);break;default:K(`Color: Unknown color model `+e)}}else if(r=/^\#([A-Fa-f\d]+)$/.exec(e)){let n=r[1],i=n.length;if(i===3)return this.setRGB(parseInt(n.charAt(0),16)/15,parseInt(n.charAt(1),16)/15,parseInt(n.charAt(2),16)/15,t);if(i===6)return this.setHex(parseInt(n,16),t);K(`Color: Invalid hex color `+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=vu){let n=df[e.toLowerCase()];return n===void 0?K(`Color: Unknown color `+e):this.setHex(n,t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=vd(e.r),this.g=vd(e.g),this.b=vd(e.b),this}copyLinearToSRGB(e){return this.r=yd(e.r),this.g=yd(e.g),this.b=yd(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=vu){return _d.workingToColorSpace(hf.copy(this),e),Math.round(J(hf.r*255,0,255))*65536+Math.round(J(hf.g*255,0,255))*256+Math.round(J(hf.b*255,0,255))}getHexString(e=vu){return(`000000`+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=_d.workingColorSpace){_d.workingToColorSpace(hf.copy(this),t);let n=hf.r,r=hf.g,i=hf.b,a=Math.max(n,r,i),o=Math.min(n,r,i),s,c,l=(o+a)/2;if(o===a)s=0,c=0;else{let e=a-o;switch(c=l<=.5?e/(a+o):e/(2-a-o),a){case n:s=(r-i)/e+(r<i?6:0);break;case r:s=(i-n)/e+2;break;case i:s=(n-r)/e+4}s/=6}return e.h=s,e.s=c,e.l=l,e}getRGB(e,t=_d.workingColorSpace){return _d.workingToColorSpace(hf.copy(this),t),e.r=hf.r,e.g=hf.g,e.b=hf.b,e}getStyle(e=vu){_d.workingToColorSpace(hf.copy(this),e);let t=hf.r,n=hf.g,r=hf.b;return e===`srgb`?`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(r*255)})`:`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${r.toFixed(3)})`}offsetHSL(e,t,n){return this.getHSL(ff),this.setHSL(ff.h+e,ff.s+t,ff.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(ff),e.getHSL(pf);let n=Wu(ff.h,pf.h,t),r=Wu(ff.s,pf.s,t),i=Wu(ff.l,pf.l,t);return this.setHSL(n,r,i),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,r=this.b,i=e.elements;return this.r=i[0]*t+i[3]*n+i[6]*r,this.g=i[1]*t+i[4]*n+i[7]*r,this.b=i[2]*t+i[5]*n+i[8]*r,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},hf=new Z;Z.NAMES=df;var gf=class extends sf{constructor(){super(),this.isScene=!0,this.type=`Scene`,this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Ud,this.environmentIntensity=1,this.environmentRotation=new Ud,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background===null?null:e.background.clone(),this.environment=e.environment===null?null:e.environment.clone(),this.fog=e.fog===null?null:e.fog.clone(),this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial===null?null:e.overrideMaterial.clone(),this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},_f=new X,vf=new X,yf=new X,bf=new X,xf=new X,Sf=new X,Cf=new X,wf=new X,Tf=new X,Ef=new X,Df=new Od,Of=new Od,kf=new Od,Af=class e{constructor(e=new X,t=new X,n=new X){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,r){r.subVectors(n,t),_f.subVectors(e,t),r.cross(_f);let i=r.lengthSq();return i>0?r.multiplyScalar(1/Math.sqrt(i)):r.set(0,0,0)}static getBarycoord(e,t,n,r,i){_f.subVectors(r,t),vf.subVectors(n,t),yf.subVectors(e,t);let a=_f.dot(_f),o=_f.dot(vf),s=_f.dot(yf),c=vf.dot(vf),l=vf.dot(yf),u=a*c-o*o;if(u===0)return i.set(0,0,0),null;let d=1/u,f=(c*s-o*l)*d,p=(a*l-o*s)*d;return i.set(1-f-p,p,f)}static containsPoint(e,t,n,r){return this.getBarycoord(e,t,n,r,bf)!==null&&bf.x>=0&&bf.y>=0&&bf.x+bf.y<=1}static getInterpolation(e,t,n,r,i,a,o,s){return this.getBarycoord(e,t,n,r,bf)===null?(s.x=0,s.y=0,`z`in s&&(s.z=0),`w`in s&&(s.w=0),null):(s.setScalar(0),s.addScaledVector(i,bf.x),s.addScaledVector(a,bf.y),s.addScaledVector(o,bf.z),s)}static getInterpolatedAttribute(e,t,n,r,i,a){return Df.setScalar(0),Of.setScalar(0),kf.setScalar(0),Df.fromBufferAttribute(e,t),Of.fromBufferAttribute(e,n),kf.fromBufferAttribute(e,r),a.setScalar(0),a.addScaledVector(Df,i.x),a.addScaledVector(Of,i.y),a.addScaledVector(kf,i.z),a}static isFrontFacing(e,t,n,r){return _f.subVectors(n,t),vf.subVectors(e,t),_f.cross(vf).dot(r)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,r){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[r]),this}setFromAttributeAndIndices(e,t,n,r){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,r),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return _f.subVectors(this.c,this.b),vf.subVectors(this.a,this.b),_f.cross(vf).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return e.getNormal(this.a,this.b,this.c,t)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,n){return e.getBarycoord(t,this.a,this.b,this.c,n)}getInterpolation(t,n,r,i,a){return e.getInterpolation(t,this.a,this.b,this.c,n,r,i,a)}containsPoint(t){return e.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return e.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,r=this.b,i=this.c,a,o;xf.subVectors(r,n),Sf.subVectors(i,n),wf.subVectors(e,n);let s=xf.dot(wf),c=Sf.dot(wf);if(s<=0&&c<=0)return t.copy(n);Tf.subVectors(e,r);let l=xf.dot(Tf),u=Sf.dot(Tf);if(l>=0&&u<=l)return t.copy(r);let d=s*u-l*c;if(d<=0&&s>=0&&l<=0&&s-l>0)return a=s/(s-l),t.copy(n).addScaledVector(xf,a);Ef.subVectors(e,i);let f=xf.dot(Ef),p=Sf.dot(Ef);if(p>=0&&f<=p)return t.copy(i);let m=f*c-s*p;if(m<=0&&c>=0&&p<=0)return o=c/(c-p),t.copy(n).addScaledVector(Sf,o);let h=l*p-f*u;if(h<=0&&u-l>=0&&f-p>=0)return Cf.subVectors(i,r),o=(u-l)/(u-l+(f-p)),t.copy(r).addScaledVector(Cf,o);let g=1/(h+m+d);return a=m*g,o=d*g,t.copy(n).addScaledVector(xf,a).addScaledVector(Sf,o)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},jf=class{constructor(e=new X(1/0,1/0,1/0),t=new X(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(Nf.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(Nf.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=Nf.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute(`position`);if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let t=0,n=r.count;t<n;t++)e.isMesh===!0?e.getVertexPosition(t,Nf):Nf.fromBufferAttribute(r,t),Nf.applyMatrix4(e.matrixWorld),this.expandByPoint(Nf);else e.boundingBox===void 0?(n.boundingBox===null&&n.computeBoundingBox(),Pf.copy(n.boundingBox)):(e.boundingBox===null&&e.computeBoundingBox(),Pf.copy(e.boundingBox)),Pf.applyMatrix4(e.matrixWorld),this.union(Pf)}let r=e.children;for(let e=0,n=r.length;e<n;e++)this.expandByObject(r[e],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Nf),Nf.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(Vf),Hf.subVectors(this.max,Vf),Ff.subVectors(e.a,Vf),If.subVectors(e.b,Vf),Lf.subVectors(e.c,Vf),Rf.subVectors(If,Ff),zf.subVectors(Lf,If),Bf.subVectors(Ff,Lf);let t=[0,-Rf.z,Rf.y,0,-zf.z,zf.y,0,-Bf.z,Bf.y,Rf.z,0,-Rf.x,zf.z,0,-zf.x,Bf.z,0,-Bf.x,-Rf.y,Rf.x,0,-zf.y,zf.x,0,-Bf.y,Bf.x,0];return!Gf(t,Ff,If,Lf,Hf)||(t=[1,0,0,0,1,0,0,0,1],!Gf(t,Ff,If,Lf,Hf))?!1:(Uf.crossVectors(Rf,zf),t=[Uf.x,Uf.y,Uf.z],Gf(t,Ff,If,Lf,Hf))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Nf).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Nf).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()||(Mf[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Mf[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Mf[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Mf[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Mf[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Mf[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Mf[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Mf[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Mf)),this}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Mf=[new X,new X,new X,new X,new X,new X,new X,new X],Nf=new X,Pf=new jf,Ff=new X,If=new X,Lf=new X,Rf=new X,zf=new X,Bf=new X,Vf=new X,Hf=new X,Uf=new X,Wf=new X;function Gf(e,t,n,r,i){for(let a=0,o=e.length-3;a<=o;a+=3){Wf.fromArray(e,a);let o=i.x*Math.abs(Wf.x)+i.y*Math.abs(Wf.y)+i.z*Math.abs(Wf.z),s=t.dot(Wf),c=n.dot(Wf),l=r.dot(Wf);if(Math.max(-Math.max(s,c,l),Math.min(s,c,l))>o)return!1}return!0}var Kf=new X,qf=new Y,Jf=0,Yf=class extends Fu{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw TypeError(`THREE.BufferAttribute: array should be a Typed Array.`);this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Jf++}),this.name=``,this.array=e,this.itemSize=t,this.count=e===void 0?0:e.length/t,this.normalized=n,this.usage=Cu,this.updateRanges=[],this.gpuType=ul,this.version=0,this._normalizationScale=e===void 0?void 0:ad(e)}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let r=0,i=this.itemSize;r<i;r++)this.array[e+r]=t.array[n+r];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)qf.fromBufferAttribute(this,t),qf.applyMatrix3(e),this.setXY(t,qf.x,qf.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)Kf.fromBufferAttribute(this,t),Kf.applyMatrix3(e),this.setXYZ(t,Kf.x,Kf.y,Kf.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)Kf.fromBufferAttribute(this,t),Kf.applyMatrix4(e),this.setXYZ(t,Kf.x,Kf.y,Kf.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)Kf.fromBufferAttribute(this,t),Kf.applyNormalMatrix(e),this.setXYZ(t,Kf.x,Kf.y,Kf.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)Kf.fromBufferAttribute(this,t),Kf.transformDirection(e),this.setXYZ(t,Kf.x,Kf.y,Kf.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this.array[e+3]=i,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:`dispose`})}_denormalize(e){let t=this._normalizationScale;return t===void 0?od(e,this.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?sd(e,this.array):Math.round(e*t)}},Xf=class extends Yf{constructor(e,t,n){super(new Uint16Array(e),t,n)}},Zf=class extends Yf{constructor(e,t,n){super(new Uint32Array(e),t,n)}},Q=class extends Yf{constructor(e,t,n){super(new Float32Array(e),t,n)}},Qf=new jf,$f=new X,ep=new X,tp=class{constructor(e=new X,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t===void 0?Qf.setFromPoints(e).getCenter(n):n.copy(t);let r=0;for(let t=0,i=e.length;t<i;t++)r=Math.max(r,n.distanceToSquared(e[t]));return this.radius=Math.sqrt(r),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius*=e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;$f.subVectors(e,this.center);let t=$f.lengthSq();if(t>this.radius*this.radius){let e=Math.sqrt(t),n=(e-this.radius)*.5;this.center.addScaledVector($f,n/e),this.radius+=n}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(ep.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint($f.copy(e.center).add(ep)),this.expandByPoint($f.copy(e.center).sub(ep))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},np=0,rp=new Nd,ip=new sf,ap=new X,op=new jf,sp=new jf,cp=new X,lp=class e extends Fu{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:np++}),this.uuid=Bu(),this.name=``,this.type=`BufferGeometry`,this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return this.index=Array.isArray(e)?new(Tu(e)?Zf:Xf)(e,1):e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let t=new fd().getNormalMatrix(e);n.applyNormalMatrix(t),n.needsUpdate=!0}let r=this.attributes.tangent;return r!==void 0&&(r.transformDirection(e),r.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return rp.makeRotationFromQuaternion(e),this.applyMatrix4(rp),this}rotateX(e){return rp.makeRotationX(e),this.applyMatrix4(rp),this}rotateY(e){return rp.makeRotationY(e),this.applyMatrix4(rp),this}rotateZ(e){return rp.makeRotationZ(e),this.applyMatrix4(rp),this}translate(e,t,n){return rp.makeTranslation(e,t,n),this.applyMatrix4(rp),this}scale(e,t,n){return rp.makeScale(e,t,n),this.applyMatrix4(rp),this}lookAt(e){return ip.lookAt(e),ip.updateMatrix(),this.applyMatrix4(ip.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(ap).negate(),this.translate(ap.x,ap.y,ap.z),this}setFromPoints(e){let t=this.getAttribute(`position`);if(t===void 0){let t=[];for(let n=0,r=e.length;n<r;n++){let r=e[n];t.push(r.x,r.y,r.z||0)}this.setAttribute(`position`,new Q(t,3))}else{let n=Math.min(e.length,t.count);for(let r=0;r<n;r++){let n=e[r];t.setXYZ(r,n.x,n.y,n.z||0)}e.length>t.count&&K(`BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry.`),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new jf);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)q(`BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.`,this),this.boundingBox.set(new X(-1/0,-1/0,-1/0),new X(1/0,1/0,1/0));else{if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];op.setFromBufferAttribute(n),this.morphTargetsRelative?(cp.addVectors(this.boundingBox.min,op.min),this.boundingBox.expandByPoint(cp),cp.addVectors(this.boundingBox.max,op.max),this.boundingBox.expandByPoint(cp)):(this.boundingBox.expandByPoint(op.min),this.boundingBox.expandByPoint(op.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&q(`BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.`,this)}}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new tp);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)q(`BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.`,this),this.boundingSphere.set(new X,1/0);else if(e){let n=this.boundingSphere.center;if(op.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];sp.setFromBufferAttribute(n),this.morphTargetsRelative?(cp.addVectors(op.min,sp.min),op.expandByPoint(cp),cp.addVectors(op.max,sp.max),op.expandByPoint(cp)):(op.expandByPoint(sp.min),op.expandByPoint(sp.max))}op.getCenter(n);let r=0;for(let t=0,i=e.count;t<i;t++)cp.fromBufferAttribute(e,t),r=Math.max(r,n.distanceToSquared(cp));if(t)for(let i=0,a=t.length;i<a;i++){let a=t[i],o=this.morphTargetsRelative;for(let t=0,i=a.count;t<i;t++)cp.fromBufferAttribute(a,t),o&&(ap.fromBufferAttribute(e,t),cp.add(ap)),r=Math.max(r,n.distanceToSquared(cp))}this.boundingSphere.radius=Math.sqrt(r),isNaN(this.boundingSphere.radius)&&q(`BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.`,this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){q(`BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)`);return}let n=t.position,r=t.normal,i=t.uv,a=this.getAttribute(`tangent`);(a===void 0||a.count!==n.count)&&(a=new Yf(new Float32Array(4*n.count),4),this.setAttribute(`tangent`,a));let o=[],s=[],c=new Uint8Array(n.count);for(let e=0;e<n.count;e++)o[e]=new X,s[e]=new X;let l=new X,u=new X,d=new X,f=new Y,p=new Y,m=new Y,h=new X,g=new X;function _(e,t,r){c[e]=c[t]=c[r]=1,l.fromBufferAttribute(n,e),u.fromBufferAttribute(n,t),d.fromBufferAttribute(n,r),f.fromBufferAttribute(i,e),p.fromBufferAttribute(i,t),m.fromBufferAttribute(i,r),u.sub(l),d.sub(l),p.sub(f),m.sub(f);let a=1/(p.x*m.y-m.x*p.y);isFinite(a)&&(h.copy(u).multiplyScalar(m.y).addScaledVector(d,-p.y).multiplyScalar(a),g.copy(d).multiplyScalar(p.x).addScaledVector(u,-m.x).multiplyScalar(a),o[e].add(h),o[t].add(h),o[r].add(h),s[e].add(g),s[t].add(g),s[r].add(g))}let v=this.groups;v.length===0&&(v=[{start:0,count:e.count}]);for(let t=0,n=v.length;t<n;++t){let n=v[t],r=n.start,i=n.count;for(let t=r,n=r+i;t<n;t+=3)_(e.getX(t+0),e.getX(t+1),e.getX(t+2))}let y=new X,b=new X,x=new X,S=new X;function C(e){x.fromBufferAttribute(r,e),S.copy(x);let t=o[e];y.copy(t),y.sub(x.multiplyScalar(x.dot(t))).normalize(),b.crossVectors(S,t);let n=b.dot(s[e])<0?-1:1;a.setXYZW(e,y.x,y.y,y.z,n)}for(let e=0,t=n.count;e<t;++e)c[e]&&C(e);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute(`position`);if(t!==void 0){let n=this.getAttribute(`normal`);if(n===void 0||n.count!==t.count)n=new Yf(new Float32Array(t.count*3),3),this.setAttribute(`normal`,n);else for(let e=0,t=n.count;e<t;e++)n.setXYZ(e,0,0,0);let r=new X,i=new X,a=new X,o=new X,s=new X,c=new X,l=new X,u=new X;if(e)for(let d=0,f=e.count;d<f;d+=3){let f=e.getX(d+0),p=e.getX(d+1),m=e.getX(d+2);r.fromBufferAttribute(t,f),i.fromBufferAttribute(t,p),a.fromBufferAttribute(t,m),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),o.fromBufferAttribute(n,f),s.fromBufferAttribute(n,p),c.fromBufferAttribute(n,m),o.add(l),s.add(l),c.add(l),n.setXYZ(f,o.x,o.y,o.z),n.setXYZ(p,s.x,s.y,s.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let e=0,o=t.count;e<o;e+=3)r.fromBufferAttribute(t,e+0),i.fromBufferAttribute(t,e+1),a.fromBufferAttribute(t,e+2),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),n.setXYZ(e+0,l.x,l.y,l.z),n.setXYZ(e+1,l.x,l.y,l.z),n.setXYZ(e+2,l.x,l.y,l.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)cp.fromBufferAttribute(e,t),cp.normalize(),e.setXYZ(t,cp.x,cp.y,cp.z)}toNonIndexed(){function t(e,t){let n=e.array,r=e.itemSize,i=e.normalized,a=new n.constructor(t.length*r),o=0,s=0;for(let i=0,c=t.length;i<c;i++){o=e.isInterleavedBufferAttribute?t[i]*e.data.stride+e.offset:t[i]*r;for(let e=0;e<r;e++)a[s++]=n[o++]}return new Yf(a,r,i)}if(this.index===null)return K(`BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed.`),this;let n=new e,r=this.index.array,i=this.attributes;for(let e in i){let a=i[e],o=t(a,r);n.setAttribute(e,o)}let a=this.morphAttributes;for(let e in a){let i=[],o=a[e];for(let e=0,n=o.length;e<n;e++){let n=o[e],a=t(n,r);i.push(a)}n.morphAttributes[e]=i}n.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let e=0,t=o.length;e<t;e++){let t=o[e];n.addGroup(t.start,t.count,t.materialIndex)}return n}toJSON(){let e={metadata:{version:4.7,type:`BufferGeometry`,generator:`BufferGeometry.toJSON`}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?`BufferGeometry`:this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let t=this.parameters;for(let n in t)t[n]!==void 0&&(e[n]=t[n]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let t in n){let r=n[t];e.data.attributes[t]=r.toJSON(e.data)}let r={},i=!1;for(let t in this.morphAttributes){let n=this.morphAttributes[t],a=[];for(let t=0,r=n.length;t<r;t++){let r=n[t];a.push(r.toJSON(e.data))}a.length>0&&(r[t]=a,i=!0)}i&&(e.data.morphAttributes=r,e.data.morphTargetsRelative=this.morphTargetsRelative);let a=this.groups;a.length>0&&(e.data.groups=JSON.parse(JSON.stringify(a)));let o=this.boundingSphere;return o!==null&&(e.data.boundingSphere=o.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let r=e.attributes;for(let e in r){let n=r[e];this.setAttribute(e,n.clone(t))}let i=e.morphAttributes;for(let e in i){let n=[],r=i[e];for(let e=0,i=r.length;e<i;e++)n.push(r[e].clone(t));this.morphAttributes[e]=n}this.morphTargetsRelative=e.morphTargetsRelative;let a=e.groups;for(let e=0,t=a.length;e<t;e++){let t=a[e];this.addGroup(t.start,t.count,t.materialIndex)}let o=e.boundingBox;o!==null&&(this.boundingBox=o.clone());let s=e.boundingSphere;return s!==null&&(this.boundingSphere=s.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:`dispose`})}},up=class{constructor(e,t){this.isInterleavedBuffer=!0,this.array=e,this.stride=t,this.count=e===void 0?0:e.length/t,this.usage=Cu,this.updateRanges=[],this.version=0,this.uuid=Bu()}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.array=new e.array.constructor(e.array),this.count=e.count,this.stride=e.stride,this.usage=e.usage,this}copyAt(e,t,n){e*=this.stride,n*=t.stride;for(let r=0,i=this.stride;r<i;r++)this.array[e+r]=t.array[n+r];return this}set(e,t=0){return this.array.set(e,t),this}clone(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=dp(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=this.array.slice(0).buffer);let n=new this.array.constructor(e.arrayBuffers[t]),r=new this.constructor(n,this.stride);return r.setUsage(this.usage),r}onUpload(e){return this.onUploadCallback=e,this}toJSON(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=dp(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=Array.from(new Uint32Array(this.array.slice(0).buffer)));let n={uuid:this.uuid,buffer:t,type:this.array.constructor.name,stride:this.stride};return n.usage=this.usage,n}};function dp(e){return e.buffer._uuid===void 0&&(e.buffer._uuid=Bu()),e.byteOffset===0&&e.byteLength===e.buffer.byteLength?e.buffer._uuid:e.buffer._uuid+`:`+e.byteOffset+`:`+e.byteLength}var fp=new X,pp=class e{constructor(e,t,n,r=!1){this.isInterleavedBufferAttribute=!0,this.name=``,this.data=e,this.itemSize=t,this.offset=n,this.normalized=r,this._normalizationScale=e===void 0?void 0:ad(e.array)}get count(){return this.data.count}get array(){return this.data.array}set needsUpdate(e){this.data.needsUpdate=e}applyMatrix4(e){for(let t=0,n=this.data.count;t<n;t++)fp.fromBufferAttribute(this,t),fp.applyMatrix4(e),this.setXYZ(t,fp.x,fp.y,fp.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)fp.fromBufferAttribute(this,t),fp.applyNormalMatrix(e),this.setXYZ(t,fp.x,fp.y,fp.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)fp.fromBufferAttribute(this,t),fp.transformDirection(e),this.setXYZ(t,fp.x,fp.y,fp.z);return this}getComponent(e,t){let n=this.array[e*this.data.stride+this.offset+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.data.array[e*this.data.stride+this.offset+t]=n,this}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset]=t,this}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+1]=t,this}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+2]=t,this}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+3]=t,this}getX(e){let t=this.data.array[e*this.data.stride+this.offset];return this.normalized&&(t=this._denormalize(t)),t}getY(e){let t=this.data.array[e*this.data.stride+this.offset+1];return this.normalized&&(t=this._denormalize(t)),t}getZ(e){let t=this.data.array[e*this.data.stride+this.offset+2];return this.normalized&&(t=this._denormalize(t)),t}getW(e){let t=this.data.array[e*this.data.stride+this.offset+3];return this.normalized&&(t=this._denormalize(t)),t}setXY(e,t,n){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.data.array[e+0]=t,this.data.array[e+1]=n,this}setXYZ(e,t,n,r){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this.data.array[e+3]=i,this}clone(t){if(t===void 0){Au(`InterleavedBufferAttribute.clone(): Cloning an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return new Yf(new this.array.constructor(e),this.itemSize,this.normalized)}return t.interleavedBuffers===void 0&&(t.interleavedBuffers={}),t.interleavedBuffers[this.data.uuid]===void 0&&(t.interleavedBuffers[this.data.uuid]=this.data.clone(t)),new e(t.interleavedBuffers[this.data.uuid],this.itemSize,this.offset,this.normalized)}toJSON(e){if(e===void 0){Au(`InterleavedBufferAttribute.toJSON(): Serializing an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return{itemSize:this.itemSize,type:this.array.constructor.name,array:e,normalized:this.normalized}}return e.interleavedBuffers===void 0&&(e.interleavedBuffers={}),e.interleavedBuffers[this.data.uuid]===void 0&&(e.interleavedBuffers[this.data.uuid]=this.data.toJSON(e)),{isInterleavedBufferAttribute:!0,itemSize:this.itemSize,data:this.data.uuid,offset:this.offset,normalized:this.normalized}}_denormalize(e){let t=this._normalizationScale;return t===void 0?od(e,this.data.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?sd(e,this.data.array):Math.round(e*t)}},mp=new X,hp=new X,gp=new fd,_p=class{constructor(e=new X(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,r){return this.normal.set(e,t,n),this.constant=r,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let r=mp.subVectors(n,t).cross(hp.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(r,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let r=e.delta(mp),i=this.normal.dot(r);if(i===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let a=-(e.start.dot(this.normal)+this.constant)/i;return n===!0&&(a<0||a>1)?null:t.copy(e.start).addScaledVector(r,a)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||gp.getNormalMatrix(e),r=this.coplanarPoint(mp).applyMatrix4(e),i=this.normal.applyMatrix3(n).normalize();return this.constant=-r.dot(i),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},vp=0,yp=class extends Fu{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:vp++}),this.uuid=Bu(),this.name=``,this.type=`Material`,this.blending=1,this.side=0,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=204,this.blendDst=205,this.blendEquation=100,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new Z(0,0,0),this.blendAlpha=0,this.depthFunc=3,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=519,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=Su,this.stencilZFail=Su,this.stencilZPass=Su,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){K(`Material: parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?K(`Material: '${t}' is not a property of THREE.${this.type}.`):r&&r.isColor?r.set(n):r&&r.isVector2&&n&&n.isVector2||r&&r.isEuler&&n&&n.isEuler||r&&r.isVector3&&n&&n.isVector3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:`Material`,generator:`Material.toJSON`}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(e=>e.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function r(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}if(t){let t=r(e.textures),i=r(e.images);t.length>0&&(n.textures=t),i.length>0&&(n.images=i)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new Z().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(e=>new _p().fromJSON(e))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(this.vertexColors=typeof e.vertexColors==`number`?e.vertexColors>0:e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let t=e.normalScale;Array.isArray(t)===!1&&(t=[t,t]),this.normalScale=new Y().fromArray(t)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new Y().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let e=t.length;n=Array(e);for(let r=0;r!==e;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:`dispose`})}set needsUpdate(e){e===!0&&this.version++}},bp=new X,xp=new X,Sp=new X,Cp=new X,wp=class{constructor(e=new X,t=new X(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,bp)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=bp.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(bp.copy(this.origin).addScaledVector(this.direction,t),bp.distanceToSquared(e))}distanceSqToSegment(e,t,n,r){xp.copy(e).add(t).multiplyScalar(.5),Sp.copy(t).sub(e).normalize(),Cp.copy(this.origin).sub(xp);let i=e.distanceTo(t)*.5,a=-this.direction.dot(Sp),o=Cp.dot(this.direction),s=-Cp.dot(Sp),c=Cp.lengthSq(),l=Math.abs(1-a*a),u,d,f,p;if(l>0){if(u=a*s-o,d=a*o-s,p=i*l,u>=0){if(d>=-p){if(d<=p){let e=1/l;u*=e,d*=e,f=u*(u+a*d+2*o)+d*(a*u+d+2*s)+c}else d=i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d=-i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d<=-p?(u=Math.max(0,-(-a*i+o)),d=u>0?-i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c):d<=p?(u=0,d=Math.min(Math.max(-i,-s),i),f=d*(d+2*s)+c):(u=Math.max(0,-(a*i+o)),d=u>0?i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c)}else d=a>0?-i:i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,u),r&&r.copy(xp).addScaledVector(Sp,d),f}intersectSphere(e,t){if(e.radius<0)return null;bp.subVectors(e.center,this.origin);let n=bp.dot(this.direction),r=bp.dot(bp)-n*n,i=e.radius*e.radius;if(r>i)return null;let a=Math.sqrt(i-r),o=n-a,s=n+a;return s<0?null:o<0?this.at(s,t):this.at(o,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,r,i,a,o,s,c=1/this.direction.x,l=1/this.direction.y,u=1/this.direction.z,d=this.origin;return c>=0?(n=(e.min.x-d.x)*c,r=(e.max.x-d.x)*c):(n=(e.max.x-d.x)*c,r=(e.min.x-d.x)*c),l>=0?(i=(e.min.y-d.y)*l,a=(e.max.y-d.y)*l):(i=(e.max.y-d.y)*l,a=(e.min.y-d.y)*l),n>a||i>r||((i>n||isNaN(n))&&(n=i),(a<r||isNaN(r))&&(r=a),u>=0?(o=(e.min.z-d.z)*u,s=(e.max.z-d.z)*u):(o=(e.max.z-d.z)*u,s=(e.min.z-d.z)*u),n>s||o>r)||((o>n||n!==n)&&(n=o),(s<r||r!==r)&&(r=s),r<0)?null:this.at(n>=0?n:r,t)}intersectsBox(e){return this.intersectBox(e,bp)!==null}intersectTriangle(e,t,n,r,i){let a=this.origin,o=this.direction,s=o.x,c=o.y,l=o.z,u=e.x-a.x,d=e.y-a.y,f=e.z-a.z,p=t.x-a.x,m=t.y-a.y,h=t.z-a.z,g=n.x-a.x,_=n.y-a.y,v=n.z-a.z,y=Math.abs(s),b=Math.abs(c),x=Math.abs(l),S,C,w,T,E,D,O,k,A,j,M,N;if(y>=b&&y>=x?(w=s,D=u,A=p,N=g,s>=0?(S=c,C=l,T=d,E=f,O=m,k=h,j=_,M=v):(S=l,C=c,T=f,E=d,O=h,k=m,j=v,M=_)):b>=x?(w=c,D=d,A=m,N=_,c>=0?(S=l,C=s,T=f,E=u,O=h,k=p,j=v,M=g):(S=s,C=l,T=u,E=f,O=p,k=h,j=g,M=v)):(w=l,D=f,A=h,N=v,l>=0?(S=s,C=c,T=u,E=d,O=p,k=m,j=g,M=_):(S=c,C=s,T=d,E=u,O=m,k=p,j=_,M=g)),w===0)return null;let ee=S/w,te=C/w,ne=1/w,re=T-ee*D,P=E-te*D,F=O-ee*A,ie=k-te*A,I=j-ee*N,L=M-te*N,R=I*ie-L*F,z=re*L-P*I,ae=F*P-ie*re;if(r){if(R<0||z<0||ae<0)return null}else if((R<0||z<0||ae<0)&&(R>0||z>0||ae>0))return null;let oe=R+z+ae;if(oe===0)return null;let se=ne*(R*D+z*A+ae*N);return(oe>0?se<0:se>0)?null:this.at(se/oe,i)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Tp=class extends yp{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type=`MeshBasicMaterial`,this.color=new Z(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Ud,this.combine=0,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},Ep=new Nd,Dp=new wp,Op=new tp,kp=new X,Ap=new X,jp=new X,Mp=new X,Np=new X,Pp=new X,Fp=new X,Ip=new X,Lp=class extends sf{constructor(e=new lp,t=new Tp){super(),this.isMesh=!0,this.type=`Mesh`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}getVertexPosition(e,t){let n=this.geometry,r=n.attributes.position,i=n.morphAttributes.position,a=n.morphTargetsRelative;t.fromBufferAttribute(r,e);let o=this.morphTargetInfluences;if(i&&o){Pp.set(0,0,0);for(let n=0,r=i.length;n<r;n++){let r=o[n],s=i[n];r!==0&&(Np.fromBufferAttribute(s,e),a?Pp.addScaledVector(Np,r):Pp.addScaledVector(Np.sub(t),r))}t.add(Pp)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.material,i=this.matrixWorld;r!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Op.copy(n.boundingSphere),Op.applyMatrix4(i),Dp.copy(e.ray).recast(e.near),Op.containsPoint(Dp.origin)===!1&&(Dp.intersectSphere(Op,kp)===null||Dp.origin.distanceToSquared(kp)>(e.far-e.near)**2)||(Ep.copy(i).invert(),Dp.copy(e.ray).applyMatrix4(Ep),(n.boundingBox===null||Dp.intersectsBox(n.boundingBox)!==!1)&&this._computeIntersections(e,t,Dp)))}_computeIntersections(e,t,n){let r,i=this.geometry,a=this.material,o=i.index,s=i.attributes.position,c=i.attributes.uv,l=i.attributes.uv1,u=i.attributes.normal,d=i.groups,f=i.drawRange;if(o!==null){if(Array.isArray(a))for(let i=0,s=d.length;i<s;i++){let s=d[i],p=a[s.materialIndex],m=Math.max(s.start,f.start),h=Math.min(o.count,Math.min(s.start+s.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=o.getX(i),d=o.getX(i+1),f=o.getX(i+2);r=zp(this,p,e,n,c,l,u,a,d,f),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=s.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),s=Math.min(o.count,f.start+f.count);for(let d=i,f=s;d<f;d+=3){let i=o.getX(d),s=o.getX(d+1),f=o.getX(d+2);r=zp(this,a,e,n,c,l,u,i,s,f),r&&(r.faceIndex=Math.floor(d/3),t.push(r))}}}else if(s!==void 0){if(Array.isArray(a))for(let i=0,o=d.length;i<o;i++){let o=d[i],p=a[o.materialIndex],m=Math.max(o.start,f.start),h=Math.min(s.count,Math.min(o.start+o.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=i,s=i+1,d=i+2;r=zp(this,p,e,n,c,l,u,a,s,d),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=o.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),o=Math.min(s.count,f.start+f.count);for(let s=i,d=o;s<d;s+=3){let i=s,o=s+1,d=s+2;r=zp(this,a,e,n,c,l,u,i,o,d),r&&(r.faceIndex=Math.floor(s/3),t.push(r))}}}}};function Rp(e,t,n,r,i,a,o,s){let c;if(c=t.side===1?r.intersectTriangle(o,a,i,!0,s):r.intersectTriangle(i,a,o,t.side===0,s),c===null)return null;Ip.copy(s),Ip.applyMatrix4(e.matrixWorld);let l=n.ray.origin.distanceTo(Ip);return l<n.near||l>n.far?null:{distance:l,point:Ip.clone(),object:e}}function zp(e,t,n,r,i,a,o,s,c,l){e.getVertexPosition(s,Ap),e.getVertexPosition(c,jp),e.getVertexPosition(l,Mp);let u=Rp(e,t,n,r,Ap,jp,Mp,Fp);if(u){let e=new X;Af.getBarycoord(Fp,Ap,jp,Mp,e),i&&(u.uv=Af.getInterpolatedAttribute(i,s,c,l,e,new Y)),a&&(u.uv1=Af.getInterpolatedAttribute(a,s,c,l,e,new Y)),o&&(u.normal=Af.getInterpolatedAttribute(o,s,c,l,e,new X),u.normal.dot(r.direction)>0&&u.normal.multiplyScalar(-1));let t={a:s,b:c,c:l,normal:new X,materialIndex:0};Af.getNormal(Ap,jp,Mp,t.normal),u.face=t,u.barycoord=e}return u}var Bp=class extends Dd{constructor(e=null,t=1,n=1,r,i,a,o,s,c=Qc,l=Qc,u,d){super(null,a,o,s,c,l,r,i,u,d),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}},Vp=class extends Yf{constructor(e,t,n,r=1){super(e,t,n),this.isInstancedBufferAttribute=!0,this.meshPerAttribute=r}copy(e){return super.copy(e),this.meshPerAttribute=e.meshPerAttribute,this}toJSON(){let e=super.toJSON();return e.meshPerAttribute=this.meshPerAttribute,e.isInstancedBufferAttribute=!0,e}},Hp=new Nd,Up=new Nd,Wp=[],Gp=new jf,Kp=new Nd,qp=new Lp,Jp=new tp,Yp=class extends Lp{constructor(e,t,n){super(e,t),this.isInstancedMesh=!0,this.instanceMatrix=new Vp(new Float32Array(n*16),16),this.instanceColor=null,this.morphTexture=null,this.count=n,this.boundingBox=null,this.boundingSphere=null;for(let e=0;e<n;e++)this.setMatrixAt(e,Kp)}computeBoundingBox(){let e=this.geometry,t=this.count;this.boundingBox===null&&(this.boundingBox=new jf),e.boundingBox===null&&e.computeBoundingBox(),this.boundingBox.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Hp),Gp.copy(e.boundingBox).applyMatrix4(Hp),this.boundingBox.union(Gp)}computeBoundingSphere(){let e=this.geometry,t=this.count;this.boundingSphere===null&&(this.boundingSphere=new tp),e.boundingSphere===null&&e.computeBoundingSphere(),this.boundingSphere.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Hp),Jp.copy(e.boundingSphere).applyMatrix4(Hp),this.boundingSphere.union(Jp)}copy(e,t){return super.copy(e,t),this.instanceMatrix.copy(e.instanceMatrix),this.morphTexture=e.morphTexture===null?null:e.morphTexture.clone(),this.instanceColor=e.instanceColor===null?null:e.instanceColor.clone(),this.count=e.count,this.boundingBox=e.boundingBox===null?null:e.boundingBox.clone(),this.boundingSphere=e.boundingSphere===null?null:e.boundingSphere.clone(),this}getColorAt(e,t){return this.instanceColor===null?t.setRGB(1,1,1):t.fromArray(this.instanceColor.array,e*3)}getMatrixAt(e,t){return t.fromArray(this.instanceMatrix.array,e*16)}getMorphAt(e,t){let n=t.morphTargetInfluences,r=this.morphTexture.source.data.data,i=e*(n.length+1)+1;for(let e=0;e<n.length;e++)n[e]=r[i+e]}raycast(e,t){let n=this.matrixWorld,r=this.count;if(qp.geometry=this.geometry,qp.material=this.material,qp.material!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),Jp.copy(this.boundingSphere),Jp.applyMatrix4(n),e.ray.intersectsSphere(Jp)!==!1))for(let i=0;i<r;i++){this.getMatrixAt(i,Hp),Up.multiplyMatrices(n,Hp),qp.matrixWorld=Up,qp.raycast(e,Wp);for(let e=0,n=Wp.length;e<n;e++){let n=Wp[e];n.instanceId=i,n.object=this,t.push(n)}Wp.length=0}}setColorAt(e,t){return this.instanceColor===null&&(this.instanceColor=new Vp(new Float32Array(this.instanceMatrix.count*3).fill(1),3)),t.toArray(this.instanceColor.array,e*3),this}setMatrixAt(e,t){return t.toArray(this.instanceMatrix.array,e*16),this}setMorphAt(e,t){let n=t.morphTargetInfluences,r=n.length+1;this.morphTexture===null&&(this.morphTexture=new Bp(new Float32Array(r*this.count),r,this.count,Sl,ul));let i=this.morphTexture.source.data.data,a=0;for(let e=0;e<n.length;e++)a+=n[e];let o=this.geometry.morphTargetsRelative?1:1-a,s=r*e;return i[s]=o,i.set(n,s+1),this}updateMorphTargets(){}dispose(){super.dispose(),this.instanceMatrix.dispose(),this.instanceColor!==null&&this.instanceColor.dispose(),this.morphTexture!==null&&(this.morphTexture.dispose(),this.morphTexture=null)}},Xp=new tp,Zp=new Y(.5,.5),Qp=new X,$p=class{constructor(e=new _p,t=new _p,n=new _p,r=new _p,i=new _p,a=new _p){this.planes=[e,t,n,r,i,a]}set(e,t,n,r,i,a){let o=this.planes;return o[0].copy(e),o[1].copy(t),o[2].copy(n),o[3].copy(r),o[4].copy(i),o[5].copy(a),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=wu,n=!1){let r=this.planes,i=e.elements,a=i[0],o=i[1],s=i[2],c=i[3],l=i[4],u=i[5],d=i[6],f=i[7],p=i[8],m=i[9],h=i[10],g=i[11],_=i[12],v=i[13],y=i[14],b=i[15];if(r[0].setComponents(c-a,f-l,g-p,b-_).normalize(),r[1].setComponents(c+a,f+l,g+p,b+_).normalize(),r[2].setComponents(c+o,f+u,g+m,b+v).normalize(),r[3].setComponents(c-o,f-u,g-m,b-v).normalize(),n)r[4].setComponents(s,d,h,y).normalize(),r[5].setComponents(c-s,f-d,g-h,b-y).normalize();else if(r[4].setComponents(c-s,f-d,g-h,b-y).normalize(),t===2e3)r[5].setComponents(c+s,f+d,g+h,b+y).normalize();else if(t===2001)r[5].setComponents(s,d,h,y).normalize();else throw Error(`THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: `+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Xp.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Xp.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Xp)}intersectsSprite(e){return Xp.center.set(0,0,0),Xp.radius=.7071067811865476+Zp.distanceTo(e.center),Xp.applyMatrix4(e.matrixWorld),this.intersectsSphere(Xp)}intersectsSphere(e){let t=this.planes,n=e.center,r=-e.radius;for(let e=0;e<6;e++)if(t[e].distanceToPoint(n)<r)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let r=t[n];if(Qp.x=r.normal.x>0?e.max.x:e.min.x,Qp.y=r.normal.y>0?e.max.y:e.min.y,Qp.z=r.normal.z>0?e.max.z:e.min.z,r.distanceToPoint(Qp)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},em=new Nd,tm=class e{constructor(){this.coordinateSystem=wu,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let e=0;e<t.length;e++){let r=t[e];em.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[e]===void 0&&(n[e]=new $p),n[e].setFromProjectionMatrix(em,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let r=0;r<e._count;r++)t[r]===void 0&&(t[r]=new $p),t[r].copy(n[r]);return this._count=e._count,this}clone(){return new e().copy(this)}},nm=class extends yp{constructor(e){super(),this.isLineBasicMaterial=!0,this.type=`LineBasicMaterial`,this.color=new Z(16777215),this.map=null,this.linewidth=1,this.linecap=`round`,this.linejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},rm=new X,im=new X,am=new Nd,om=new wp,sm=new tp,cm=new X,lm=new X,um=class extends sf{constructor(e=new lp,t=new nm){super(),this.isLine=!0,this.type=`Line`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[0];for(let e=1,r=t.count;e<r;e++)rm.fromBufferAttribute(t,e-1),im.fromBufferAttribute(t,e),n[e]=n[e-1],n[e]+=rm.distanceTo(im);e.setAttribute(`lineDistance`,new Q(n,1))}else K(`Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.`);return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.matrixWorld,i=e.params.Line.threshold,a=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),sm.copy(n.boundingSphere),sm.applyMatrix4(r),sm.radius+=i,e.ray.intersectsSphere(sm)===!1)return;am.copy(r).invert(),om.copy(e.ray).applyMatrix4(am);let o=i/((this.scale.x+this.scale.y+this.scale.z)/3),s=o*o,c=this.isLineSegments?2:1,l=n.index,u=n.attributes.position;if(l!==null){let n=Math.max(0,a.start),r=Math.min(l.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=l.getX(i),r=l.getX(i+1),a=dm(this,e,om,s,n,r,i);a&&t.push(a)}if(this.isLineLoop){let i=l.getX(r-1),a=l.getX(n),o=dm(this,e,om,s,i,a,r-1);o&&t.push(o)}}else{let n=Math.max(0,a.start),r=Math.min(u.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=dm(this,e,om,s,i,i+1,i);n&&t.push(n)}if(this.isLineLoop){let i=dm(this,e,om,s,r-1,n,r-1);i&&t.push(i)}}}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}};function dm(e,t,n,r,i,a,o){let s=e.geometry.attributes.position;if(rm.fromBufferAttribute(s,i),im.fromBufferAttribute(s,a),n.distanceSqToSegment(rm,im,cm,lm)>r)return;cm.applyMatrix4(e.matrixWorld);let c=t.ray.origin.distanceTo(cm);if(!(c<t.near||c>t.far))return{distance:c,point:lm.clone().applyMatrix4(e.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:e}}var fm=new X,pm=new X,mm=class extends um{constructor(e,t){super(e,t),this.isLineSegments=!0,this.type=`LineSegments`}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[];for(let e=0,r=t.count;e<r;e+=2)fm.fromBufferAttribute(t,e),pm.fromBufferAttribute(t,e+1),n[e]=e===0?0:n[e-1],n[e+1]=n[e]+fm.distanceTo(pm);e.setAttribute(`lineDistance`,new Q(n,1))}else K(`LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.`);return this}},hm=class extends Dd{constructor(e=[],t,n,r,i,a,o,s,c,l,u,d){super(null,a,o,s,c,l,r,i,u,d),this.isCompressedTexture=!0,this.image={width:t,height:n},this.mipmaps=e,this.flipY=!1,this.generateMipmaps=!1}},gm=class extends Dd{constructor(e=[],t=301,n,r,i,a,o,s,c,l){super(e,t,n,r,i,a,o,s,c,l),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}},_m=class extends Dd{constructor(e,t,n,r,i,a,o,s,c){super(e,t,n,r,i,a,o,s,c),this.isCanvasTexture=!0,this.needsUpdate=!0}},vm=class extends Dd{constructor(e,t,n=ll,r,i,a,o=Qc,s=Qc,c,l=bl,u=1){if(l!==1026&&l!==1027)throw Error(`THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat`);super({width:e,height:t,depth:u},r,i,a,o,s,l,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new Cd(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},ym=class extends vm{constructor(e,t=ll,n=301,r,i,a=Qc,o=Qc,s,c=bl){let l={width:e,height:e,depth:1},u=[l,l,l,l,l,l];super(e,e,t,n,r,i,a,o,s,c),this.image=u,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},bm=class extends Dd{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},xm=class e extends lp{constructor(e=1,t=1,n=1,r=1,i=1,a=1){super(),this.type=`BoxGeometry`,this.parameters={width:e,height:t,depth:n,widthSegments:r,heightSegments:i,depthSegments:a};let o=this;r=Math.floor(r),i=Math.floor(i),a=Math.floor(a);let s=[],c=[],l=[],u=[],d=0,f=0;p(`z`,`y`,`x`,-1,-1,n,t,e,a,i,0),p(`z`,`y`,`x`,1,-1,n,t,-e,a,i,1),p(`x`,`z`,`y`,1,1,e,n,t,r,a,2),p(`x`,`z`,`y`,1,-1,e,n,-t,r,a,3),p(`x`,`y`,`z`,1,-1,e,t,n,r,i,4),p(`x`,`y`,`z`,-1,-1,e,t,-n,r,i,5),this.setIndex(s),this.setAttribute(`position`,new Q(c,3)),this.setAttribute(`normal`,new Q(l,3)),this.setAttribute(`uv`,new Q(u,2));function p(e,t,n,r,i,a,p,m,h,g,_){let v=a/h,y=p/g,b=a/2,x=p/2,S=m/2,C=h+1,w=g+1,T=0,E=0,D=new X;for(let a=0;a<w;a++){let o=a*y-x;for(let s=0;s<C;s++)D[e]=(s*v-b)*r,D[t]=o*i,D[n]=S,c.push(D.x,D.y,D.z),D[e]=0,D[t]=0,D[n]=m>0?1:-1,l.push(D.x,D.y,D.z),u.push(s/h),u.push(1-a/g),T+=1}for(let e=0;e<g;e++)for(let t=0;t<h;t++){let n=d+t+C*e,r=d+t+C*(e+1),i=d+(t+1)+C*(e+1),a=d+(t+1)+C*e;s.push(n,r,a),s.push(r,i,a),E+=6}o.addGroup(f,E,_),f+=E,d+=T}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}},Sm=class e extends lp{constructor(e=1,t=1,n=1,r=32,i=1,a=!1,o=0,s=Math.PI*2){super(),this.type=`CylinderGeometry`,this.parameters={radiusTop:e,radiusBottom:t,height:n,radialSegments:r,heightSegments:i,openEnded:a,thetaStart:o,thetaLength:s};let c=this;r=Math.floor(r),i=Math.floor(i);let l=[],u=[],d=[],f=[],p=0,m=[],h=n/2,g=0;_(),a===!1&&(e>0&&v(!0),t>0&&v(!1)),this.setIndex(l),this.setAttribute(`position`,new Q(u,3)),this.setAttribute(`normal`,new Q(d,3)),this.setAttribute(`uv`,new Q(f,2));function _(){let a=new X,_=new X,v=0,y=(t-e)/n;for(let c=0;c<=i;c++){let l=[],g=c/i,v=g*(t-e)+e;for(let e=0;e<=r;e++){let t=e/r,i=t*s+o,c=Math.sin(i),m=Math.cos(i);_.x=v*c,_.y=-g*n+h,_.z=v*m,u.push(_.x,_.y,_.z),a.set(c,y,m).normalize(),d.push(a.x,a.y,a.z),f.push(t,1-g),l.push(p++)}m.push(l)}for(let n=0;n<r;n++)for(let r=0;r<i;r++){let a=m[r][n],o=m[r+1][n],s=m[r+1][n+1],c=m[r][n+1];(e>0||r!==0)&&(l.push(a,o,c),v+=3),(t>0||r!==i-1)&&(l.push(o,s,c),v+=3)}c.addGroup(g,v,0),g+=v}function v(n){let i=p,a=new Y,m=new X,_=0,v=n===!0?e:t,y=n===!0?1:-1;for(let e=1;e<=r;e++)u.push(0,h*y,0),d.push(0,y,0),f.push(.5,.5),p++;let b=p;for(let e=0;e<=r;e++){let t=e/r*s+o,n=Math.cos(t),i=Math.sin(t);m.x=v*i,m.y=h*y,m.z=v*n,u.push(m.x,m.y,m.z),d.push(0,y,0),a.x=n*.5+.5,a.y=i*.5*y+.5,f.push(a.x,a.y),p++}for(let e=0;e<r;e++){let t=i+e,r=b+e;n===!0?l.push(r,r+1,t):l.push(r+1,r,t),_+=3}c.addGroup(g,_,n===!0?1:2),g+=_}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.radiusTop,t.radiusBottom,t.height,t.radialSegments,t.heightSegments,t.openEnded,t.thetaStart,t.thetaLength)}},Cm=class e extends Sm{constructor(e=1,t=1,n=32,r=1,i=!1,a=0,o=Math.PI*2){super(0,e,t,n,r,i,a,o),this.type=`ConeGeometry`,this.parameters={radius:e,height:t,radialSegments:n,heightSegments:r,openEnded:i,thetaStart:a,thetaLength:o}}static fromJSON(t){return new e(t.radius,t.height,t.radialSegments,t.heightSegments,t.openEnded,t.thetaStart,t.thetaLength)}},wm=class e extends lp{constructor(e=[],t=[],n=1,r=0){super(),this.type=`PolyhedronGeometry`,this.parameters={vertices:e,indices:t,radius:n,detail:r};let i=[],a=[];o(r),c(n),l(),this.setAttribute(`position`,new Q(i,3)),this.setAttribute(`normal`,new Q(i.slice(),3)),this.setAttribute(`uv`,new Q(a,2)),r===0?this.computeVertexNormals():this.normalizeNormals();function o(e){let n=new X,r=new X,i=new X;for(let a=0;a<t.length;a+=3)f(t[a+0],n),f(t[a+1],r),f(t[a+2],i),s(n,r,i,e)}function s(e,t,n,r){let i=r+1,a=[];for(let r=0;r<=i;r++){a[r]=[];let o=e.clone().lerp(n,r/i),s=t.clone().lerp(n,r/i),c=i-r;for(let e=0;e<=c;e++)e===0&&r===i?a[r][e]=o:a[r][e]=o.clone().lerp(s,e/c)}for(let e=0;e<i;e++)for(let t=0;t<2*(i-e)-1;t++){let n=Math.floor(t/2);t%2==0?(d(a[e][n+1]),d(a[e+1][n]),d(a[e][n])):(d(a[e][n+1]),d(a[e+1][n+1]),d(a[e+1][n]))}}function c(e){let t=new X;for(let n=0;n<i.length;n+=3)t.x=i[n+0],t.y=i[n+1],t.z=i[n+2],t.normalize().multiplyScalar(e),i[n+0]=t.x,i[n+1]=t.y,i[n+2]=t.z}function l(){let e=new X;for(let t=0;t<i.length;t+=3){e.x=i[t+0],e.y=i[t+1],e.z=i[t+2];let n=h(e)/2/Math.PI+.5,r=g(e)/Math.PI+.5;a.push(n,1-r)}p(),u()}function u(){for(let e=0;e<a.length;e+=6){let t=a[e+0],n=a[e+2],r=a[e+4];Math.max(t,n,r)>.9&&Math.min(t,n,r)<.1&&(t<.2&&(a[e+0]+=1),n<.2&&(a[e+2]+=1),r<.2&&(a[e+4]+=1))}}function d(e){i.push(e.x,e.y,e.z)}function f(t,n){let r=t*3;n.x=e[r+0],n.y=e[r+1],n.z=e[r+2]}function p(){let e=new X,t=new X,n=new X,r=new X,o=new Y,s=new Y,c=new Y;for(let l=0,u=0;l<i.length;l+=9,u+=6){e.set(i[l+0],i[l+1],i[l+2]),t.set(i[l+3],i[l+4],i[l+5]),n.set(i[l+6],i[l+7],i[l+8]),o.set(a[u+0],a[u+1]),s.set(a[u+2],a[u+3]),c.set(a[u+4],a[u+5]),r.copy(e).add(t).add(n).divideScalar(3);let d=h(r);m(o,u+0,e,d),m(s,u+2,t,d),m(c,u+4,n,d)}}function m(e,t,n,r){r<0&&e.x===1&&(a[t]=e.x-1),n.x===0&&n.z===0&&(a[t]=r/2/Math.PI+.5)}function h(e){return Math.atan2(e.z,-e.x)}function g(e){return Math.atan2(-e.y,Math.sqrt(e.x*e.x+e.z*e.z))}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.vertices,t.indices,t.radius,t.detail)}},Tm=new X,Em=new X,Dm=new X,Om=new Af,km=class extends lp{constructor(e=null,t=1){if(super(),this.type=`EdgesGeometry`,this.parameters={geometry:e,thresholdAngle:t},e!==null){let n=1e4,r=Math.cos(Ru*t),i=e.getIndex(),a=e.getAttribute(`position`),o=i?i.count:a.count,s=[0,0,0],c=[`a`,`b`,`c`],l=[,,,],u=new Map,d=[];for(let e=0;e<o;e+=3){i?(s[0]=i.getX(e),s[1]=i.getX(e+1),s[2]=i.getX(e+2)):(s[0]=e,s[1]=e+1,s[2]=e+2);let{a:t,b:o,c:f}=Om;if(t.fromBufferAttribute(a,s[0]),o.fromBufferAttribute(a,s[1]),f.fromBufferAttribute(a,s[2]),Om.getNormal(Dm),l[0]=`${Math.round(t.x*n)},${Math.round(t.y*n)},${Math.round(t.z*n)}`,l[1]=`${Math.round(o.x*n)},${Math.round(o.y*n)},${Math.round(o.z*n)}`,l[2]=`${Math.round(f.x*n)},${Math.round(f.y*n)},${Math.round(f.z*n)}`,l[0]!==l[1]&&l[1]!==l[2]&&l[2]!==l[0])for(let e=0;e<3;e++){let t=(e+1)%3,n=l[e],i=l[t],a=Om[c[e]],o=Om[c[t]],f=`${n}_${i}`,p=`${i}_${n}`,m=u.get(p);m?(Dm.dot(m.normal)<=r&&(d.push(a.x,a.y,a.z),d.push(o.x,o.y,o.z)),u.set(p,null)):u.has(f)||u.set(f,{index0:s[e],index1:s[t],normal:Dm.clone()})}}for(let e of u.values())if(e){let{index0:t,index1:n}=e;Tm.fromBufferAttribute(a,t),Em.fromBufferAttribute(a,n),d.push(Tm.x,Tm.y,Tm.z),d.push(Em.x,Em.y,Em.z)}this.setAttribute(`position`,new Q(d,3))}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}},Am=class{constructor(){this.type=`Curve`,this.arcLengthDivisions=200,this.needsUpdate=!1,this.cacheArcLengths=null}getPoint(){K(`Curve: .getPoint() not implemented.`)}getPointAt(e,t){let n=this.getUtoTmapping(e);return this.getPoint(n,t)}getPoints(e=5){let t=[];for(let n=0;n<=e;n++)t.push(this.getPoint(n/e));return t}getSpacedPoints(e=5){let t=[];for(let n=0;n<=e;n++)t.push(this.getPointAt(n/e));return t}getLength(){let e=this.getLengths();return e[e.length-1]}getLengths(e=this.arcLengthDivisions){if(this.cacheArcLengths&&this.cacheArcLengths.length===e+1&&!this.needsUpdate)return this.cacheArcLengths;this.needsUpdate=!1;let t=[],n,r=this.getPoint(0),i=0;t.push(0);for(let a=1;a<=e;a++)n=this.getPoint(a/e),i+=n.distanceTo(r),t.push(i),r=n;return this.cacheArcLengths=t,t}updateArcLengths(){this.needsUpdate=!0,this.getLengths()}getUtoTmapping(e,t=null){let n=this.getLengths(),r=0,i=n.length,a;a=t||e*n[i-1];let o=0,s=i-1,c;for(;o<=s;)if(r=Math.floor(o+(s-o)/2),c=n[r]-a,c<0)o=r+1;else if(c>0)s=r-1;else{s=r;break}if(r=s,n[r]===a)return r/(i-1);let l=n[r],u=n[r+1]-l,d=(a-l)/u;return(r+d)/(i-1)}getTangent(e,t){let n=1e-4,r=e-n,i=e+n;r<0&&(r=0),i>1&&(i=1);let a=this.getPoint(r),o=this.getPoint(i),s=t||(a.isVector2?new Y:new X);return s.copy(o).sub(a).normalize(),s}getTangentAt(e,t){let n=this.getUtoTmapping(e);return this.getTangent(n,t)}computeFrenetFrames(e,t=!1){let n=new X,r=[],i=[],a=[],o=new X,s=new Nd;for(let t=0;t<=e;t++){let n=t/e;r[t]=this.getTangentAt(n,new X)}i[0]=new X,a[0]=new X;let c=Number.MAX_VALUE,l=Math.abs(r[0].x),u=Math.abs(r[0].y),d=Math.abs(r[0].z);l<=c&&(c=l,n.set(1,0,0)),u<=c&&(c=u,n.set(0,1,0)),d<=c&&n.set(0,0,1),o.crossVectors(r[0],n).normalize(),i[0].crossVectors(r[0],o),a[0].crossVectors(r[0],i[0]);for(let t=1;t<=e;t++){if(i[t]=i[t-1].clone(),a[t]=a[t-1].clone(),o.crossVectors(r[t-1],r[t]),o.length()>2**-52){o.normalize();let e=Math.acos(J(r[t-1].dot(r[t]),-1,1));i[t].applyMatrix4(s.makeRotationAxis(o,e))}a[t].crossVectors(r[t],i[t])}if(t===!0){let t=Math.acos(J(i[0].dot(i[e]),-1,1));t/=e,r[0].dot(o.crossVectors(i[0],i[e]))>0&&(t=-t);for(let n=1;n<=e;n++)i[n].applyMatrix4(s.makeRotationAxis(r[n],t*n)),a[n].crossVectors(r[n],i[n])}return{tangents:r,normals:i,binormals:a}}clone(){return new this.constructor().copy(this)}copy(e){return this.arcLengthDivisions=e.arcLengthDivisions,this.cacheArcLengths=null,this}toJSON(){let e={metadata:{version:4.7,type:`Curve`,generator:`Curve.toJSON`}};return e.arcLengthDivisions=this.arcLengthDivisions,e.type=this.type,e}fromJSON(e){return this.arcLengthDivisions=e.arcLengthDivisions,this.cacheArcLengths=null,this}},jm=class extends Am{constructor(e=0,t=0,n=1,r=1,i=0,a=Math.PI*2,o=!1,s=0){super(),this.isEllipseCurve=!0,this.type=`EllipseCurve`,this.aX=e,this.aY=t,this.xRadius=n,this.yRadius=r,this.aStartAngle=i,this.aEndAngle=a,this.aClockwise=o,this.aRotation=s}getPoint(e,t=new Y){let n=t,r=Math.PI*2,i=this.aEndAngle-this.aStartAngle,a=Math.abs(i)<2**-52;for(;i<0;)i+=r;for(;i>r;)i-=r;i<2**-52&&(i=a?0:r),this.aClockwise===!0&&!a&&(i===r?i=-r:i-=r);let o=this.aStartAngle+e*i,s=this.aX+this.xRadius*Math.cos(o),c=this.aY+this.yRadius*Math.sin(o);if(this.aRotation!==0){let e=Math.cos(this.aRotation),t=Math.sin(this.aRotation),n=s-this.aX,r=c-this.aY;s=n*e-r*t+this.aX,c=n*t+r*e+this.aY}return n.set(s,c)}copy(e){return super.copy(e),this.aX=e.aX,this.aY=e.aY,this.xRadius=e.xRadius,this.yRadius=e.yRadius,this.aStartAngle=e.aStartAngle,this.aEndAngle=e.aEndAngle,this.aClockwise=e.aClockwise,this.aRotation=e.aRotation,this}toJSON(){let e=super.toJSON();return e.aX=this.aX,e.aY=this.aY,e.xRadius=this.xRadius,e.yRadius=this.yRadius,e.aStartAngle=this.aStartAngle,e.aEndAngle=this.aEndAngle,e.aClockwise=this.aClockwise,e.aRotation=this.aRotation,e}fromJSON(e){return super.fromJSON(e),this.aX=e.aX,this.aY=e.aY,this.xRadius=e.xRadius,this.yRadius=e.yRadius,this.aStartAngle=e.aStartAngle,this.aEndAngle=e.aEndAngle,this.aClockwise=e.aClockwise,this.aRotation=e.aRotation,this}},Mm=class extends jm{constructor(e,t,n,r,i,a){super(e,t,n,n,r,i,a),this.isArcCurve=!0,this.type=`ArcCurve`}};function Nm(){let e=0,t=0,n=0,r=0;function i(i,a,o,s){e=i,t=o,n=-3*i+3*a-2*o-s,r=2*i-2*a+o+s}return{initCatmullRom:function(e,t,n,r,a){i(t,n,a*(n-e),a*(r-t))},initNonuniformCatmullRom:function(e,t,n,r,a,o,s){let c=(t-e)/a-(n-e)/(a+o)+(n-t)/o,l=(n-t)/o-(r-t)/(o+s)+(r-n)/s;c*=o,l*=o,i(t,n,c,l)},calc:function(i){let a=i*i,o=a*i;return e+t*i+n*a+r*o}}}var Pm=new X,Fm=new X,Im=new Nm,Lm=new Nm,Rm=new Nm,zm=class extends Am{constructor(e=[],t=!1,n=`centripetal`,r=.5){super(),this.isCatmullRomCurve3=!0,this.type=`CatmullRomCurve3`,this.points=e,this.closed=t,this.curveType=n,this.tension=r}getPoint(e,t=new X){let n=t,r=this.points,i=r.length,a=(i-+!this.closed)*e,o=Math.floor(a),s=a-o;this.closed?o+=o>0?0:(Math.floor(Math.abs(o)/i)+1)*i:s===0&&o===i-1&&(o=i-2,s=1);let c,l;this.closed||o>0?c=r[(o-1)%i]:(Fm.subVectors(r[0],r[1]).add(r[0]),c=Fm);let u=r[o%i],d=r[(o+1)%i];if(this.closed||o+2<i?l=r[(o+2)%i]:(Pm.subVectors(r[i-1],r[i-2]).add(r[i-1]),l=Pm),this.curveType===`centripetal`||this.curveType===`chordal`){let e=this.curveType===`chordal`?.5:.25,t=c.distanceToSquared(u)**+e,n=u.distanceToSquared(d)**+e,r=d.distanceToSquared(l)**+e;n<1e-4&&(n=1),t<1e-4&&(t=n),r<1e-4&&(r=n),Im.initNonuniformCatmullRom(c.x,u.x,d.x,l.x,t,n,r),Lm.initNonuniformCatmullRom(c.y,u.y,d.y,l.y,t,n,r),Rm.initNonuniformCatmullRom(c.z,u.z,d.z,l.z,t,n,r)}else this.curveType===`catmullrom`&&(Im.initCatmullRom(c.x,u.x,d.x,l.x,this.tension),Lm.initCatmullRom(c.y,u.y,d.y,l.y,this.tension),Rm.initCatmullRom(c.z,u.z,d.z,l.z,this.tension));return n.set(Im.calc(s),Lm.calc(s),Rm.calc(s)),n}copy(e){super.copy(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(n.clone())}return this.closed=e.closed,this.curveType=e.curveType,this.tension=e.tension,this}toJSON(){let e=super.toJSON();e.points=[];for(let t=0,n=this.points.length;t<n;t++){let n=this.points[t];e.points.push(n.toArray())}return e.closed=this.closed,e.curveType=this.curveType,e.tension=this.tension,e}fromJSON(e){super.fromJSON(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(new X().fromArray(n))}return this.closed=e.closed,this.curveType=e.curveType,this.tension=e.tension,this}};function Bm(e,t,n,r,i){let a=(r-t)*.5,o=(i-n)*.5,s=e*e,c=e*s;return(2*n-2*r+a+o)*c+(-3*n+3*r-2*a-o)*s+a*e+n}function Vm(e,t){let n=1-e;return n*n*t}function Hm(e,t){return 2*(1-e)*e*t}function Um(e,t){return e*e*t}function Wm(e,t,n,r){return Vm(e,t)+Hm(e,n)+Um(e,r)}function Gm(e,t){let n=1-e;return n*n*n*t}function Km(e,t){let n=1-e;return 3*n*n*e*t}function qm(e,t){return 3*(1-e)*e*e*t}function Jm(e,t){return e*e*e*t}function Ym(e,t,n,r,i){return Gm(e,t)+Km(e,n)+qm(e,r)+Jm(e,i)}var Xm=class extends Am{constructor(e=new Y,t=new Y,n=new Y,r=new Y){super(),this.isCubicBezierCurve=!0,this.type=`CubicBezierCurve`,this.v0=e,this.v1=t,this.v2=n,this.v3=r}getPoint(e,t=new Y){let n=t,r=this.v0,i=this.v1,a=this.v2,o=this.v3;return n.set(Ym(e,r.x,i.x,a.x,o.x),Ym(e,r.y,i.y,a.y,o.y)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this.v3.copy(e.v3),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e.v3=this.v3.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this.v3.fromArray(e.v3),this}},Zm=class extends Am{constructor(e=new X,t=new X,n=new X,r=new X){super(),this.isCubicBezierCurve3=!0,this.type=`CubicBezierCurve3`,this.v0=e,this.v1=t,this.v2=n,this.v3=r}getPoint(e,t=new X){let n=t,r=this.v0,i=this.v1,a=this.v2,o=this.v3;return n.set(Ym(e,r.x,i.x,a.x,o.x),Ym(e,r.y,i.y,a.y,o.y),Ym(e,r.z,i.z,a.z,o.z)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this.v3.copy(e.v3),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e.v3=this.v3.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this.v3.fromArray(e.v3),this}},Qm=class extends Am{constructor(e=new Y,t=new Y){super(),this.isLineCurve=!0,this.type=`LineCurve`,this.v1=e,this.v2=t}getPoint(e,t=new Y){let n=t;return e===1?n.copy(this.v2):(n.copy(this.v2).sub(this.v1),n.multiplyScalar(e).add(this.v1)),n}getPointAt(e,t){return this.getPoint(e,t)}getTangent(e,t=new Y){return t.subVectors(this.v2,this.v1).normalize()}getTangentAt(e,t){return this.getTangent(e,t)}copy(e){return super.copy(e),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},$m=class extends Am{constructor(e=new X,t=new X){super(),this.isLineCurve3=!0,this.type=`LineCurve3`,this.v1=e,this.v2=t}getPoint(e,t=new X){let n=t;return e===1?n.copy(this.v2):(n.copy(this.v2).sub(this.v1),n.multiplyScalar(e).add(this.v1)),n}getPointAt(e,t){return this.getPoint(e,t)}getTangent(e,t=new X){return t.subVectors(this.v2,this.v1).normalize()}getTangentAt(e,t){return this.getTangent(e,t)}copy(e){return super.copy(e),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},eh=class extends Am{constructor(e=new Y,t=new Y,n=new Y){super(),this.isQuadraticBezierCurve=!0,this.type=`QuadraticBezierCurve`,this.v0=e,this.v1=t,this.v2=n}getPoint(e,t=new Y){let n=t,r=this.v0,i=this.v1,a=this.v2;return n.set(Wm(e,r.x,i.x,a.x),Wm(e,r.y,i.y,a.y)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},th=class extends Am{constructor(e=new X,t=new X,n=new X){super(),this.isQuadraticBezierCurve3=!0,this.type=`QuadraticBezierCurve3`,this.v0=e,this.v1=t,this.v2=n}getPoint(e,t=new X){let n=t,r=this.v0,i=this.v1,a=this.v2;return n.set(Wm(e,r.x,i.x,a.x),Wm(e,r.y,i.y,a.y),Wm(e,r.z,i.z,a.z)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},nh=class extends Am{constructor(e=[]){super(),this.isSplineCurve=!0,this.type=`SplineCurve`,this.points=e}getPoint(e,t=new Y){let n=t,r=this.points,i=(r.length-1)*e,a=Math.floor(i),o=i-a,s=r[a===0?a:a-1],c=r[a],l=r[a>r.length-2?r.length-1:a+1],u=r[a>r.length-3?r.length-1:a+2];return n.set(Bm(o,s.x,c.x,l.x,u.x),Bm(o,s.y,c.y,l.y,u.y)),n}copy(e){super.copy(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(n.clone())}return this}toJSON(){let e=super.toJSON();e.points=[];for(let t=0,n=this.points.length;t<n;t++){let n=this.points[t];e.points.push(n.toArray())}return e}fromJSON(e){super.fromJSON(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(new Y().fromArray(n))}return this}},rh=Object.freeze({__proto__:null,ArcCurve:Mm,CatmullRomCurve3:zm,CubicBezierCurve:Xm,CubicBezierCurve3:Zm,EllipseCurve:jm,LineCurve:Qm,LineCurve3:$m,QuadraticBezierCurve:eh,QuadraticBezierCurve3:th,SplineCurve:nh}),ih=class extends Am{constructor(){super(),this.type=`CurvePath`,this.curves=[],this.autoClose=!1,this.cacheLengths=null}add(e){this.curves.push(e)}closePath(){let e=this.curves[0].getPoint(0),t=this.curves[this.curves.length-1].getPoint(1);if(!e.equals(t)){let n=e.isVector2===!0?`LineCurve`:`LineCurve3`;this.curves.push(new rh[n](t,e))}return this}getPoint(e,t){let n=e*this.getLength(),r=this.getCurveLengths(),i=0;for(;i<r.length;){if(r[i]>=n){let e=r[i]-n,a=this.curves[i],o=a.getLength(),s=o===0?0:1-e/o;return a.getPointAt(s,t)}i++}return null}getLength(){let e=this.getCurveLengths();return e[e.length-1]}updateArcLengths(){this.needsUpdate=!0,this.cacheLengths=null,this.getCurveLengths()}getCurveLengths(){if(this.cacheLengths&&this.cacheLengths.length===this.curves.length)return this.cacheLengths;let e=[],t=0;for(let n=0,r=this.curves.length;n<r;n++)t+=this.curves[n].getLength(),e.push(t);return this.cacheLengths=e,e}getSpacedPoints(e=40){let t=[];for(let n=0;n<=e;n++)t.push(this.getPoint(n/e));return this.autoClose&&t.push(t[0]),t}getPoints(e=12){let t=[],n;for(let r=0,i=this.curves;r<i.length;r++){let a=i[r],o=a.isEllipseCurve?e*2:a.isLineCurve||a.isLineCurve3?1:a.isSplineCurve?e*a.points.length:e,s=a.getPoints(o);for(let e=0;e<s.length;e++){let r=s[e];n&&n.equals(r)||(t.push(r),n=r)}}return this.autoClose&&t.length>1&&!t[t.length-1].equals(t[0])&&t.push(t[0]),t}copy(e){super.copy(e),this.curves=[];for(let t=0,n=e.curves.length;t<n;t++){let n=e.curves[t];this.curves.push(n.clone())}return this.autoClose=e.autoClose,this.cacheLengths=null,this}toJSON(){let e=super.toJSON();e.autoClose=this.autoClose,e.curves=[];for(let t=0,n=this.curves.length;t<n;t++){let n=this.curves[t];e.curves.push(n.toJSON())}return e}fromJSON(e){super.fromJSON(e),this.autoClose=e.autoClose,this.curves=[];for(let t=0,n=e.curves.length;t<n;t++){let n=e.curves[t];this.curves.push(new rh[n.type]().fromJSON(n))}return this.cacheLengths=null,this}},ah=class extends ih{constructor(e){super(),this.type=`Path`,this.currentPoint=new Y,e&&this.setFromPoints(e)}setFromPoints(e){this.moveTo(e[0].x,e[0].y);for(let t=1,n=e.length;t<n;t++)this.lineTo(e[t].x,e[t].y);return this}moveTo(e,t){return this.currentPoint.set(e,t),this}lineTo(e,t){let n=new Qm(this.currentPoint.clone(),new Y(e,t));return this.curves.push(n),this.currentPoint.set(e,t),this}quadraticCurveTo(e,t,n,r){let i=new eh(this.currentPoint.clone(),new Y(e,t),new Y(n,r));return this.curves.push(i),this.currentPoint.set(n,r),this}bezierCurveTo(e,t,n,r,i,a){let o=new Xm(this.currentPoint.clone(),new Y(e,t),new Y(n,r),new Y(i,a));return this.curves.push(o),this.currentPoint.set(i,a),this}splineThru(e){let t=new nh([this.currentPoint.clone()].concat(e));return this.curves.push(t),this.currentPoint.copy(e[e.length-1]),this}arc(e,t,n,r,i,a){let o=this.currentPoint.x,s=this.currentPoint.y;return this.absarc(e+o,t+s,n,r,i,a),this}absarc(e,t,n,r,i,a){return this.absellipse(e,t,n,n,r,i,a),this}ellipse(e,t,n,r,i,a,o,s){let c=this.currentPoint.x,l=this.currentPoint.y;return this.absellipse(e+c,t+l,n,r,i,a,o,s),this}absellipse(e,t,n,r,i,a,o,s){let c=new jm(e,t,n,r,i,a,o,s);if(this.curves.length>0){let e=c.getPoint(0);e.equals(this.currentPoint)||this.lineTo(e.x,e.y)}this.curves.push(c);let l=c.getPoint(1);return this.currentPoint.copy(l),this}copy(e){return super.copy(e),this.currentPoint.copy(e.currentPoint),this}toJSON(){let e=super.toJSON();return e.currentPoint=this.currentPoint.toArray(),e}fromJSON(e){return super.fromJSON(e),this.currentPoint.fromArray(e.currentPoint),this}},oh=class extends ah{constructor(e){super(e),this.uuid=Bu(),this.type=`Shape`,this.holes=[]}getPointsHoles(e){let t=[];for(let n=0,r=this.holes.length;n<r;n++)t[n]=this.holes[n].getPoints(e);return t}extractPoints(e){return{shape:this.getPoints(e),holes:this.getPointsHoles(e)}}copy(e){super.copy(e),this.holes=[];for(let t=0,n=e.holes.length;t<n;t++){let n=e.holes[t];this.holes.push(n.clone())}return this}toJSON(){let e=super.toJSON();e.uuid=this.uuid,e.holes=[];for(let t=0,n=this.holes.length;t<n;t++){let n=this.holes[t];e.holes.push(n.toJSON())}return e}fromJSON(e){super.fromJSON(e),this.uuid=e.uuid,this.holes=[];for(let t=0,n=e.holes.length;t<n;t++){let n=e.holes[t];this.holes.push(new ah().fromJSON(n))}return this}};function sh(e,t,n=2){let r=t&&t.length,i=r?t[0]*n:e.length,a=ch(e,0,i,n,!0),o=[];if(!a||a.next===a.prev)return o;let s,c,l;if(r&&(a=hh(e,t,a,n)),e.length>80*n){s=e[0],c=e[1];let t=s,r=c;for(let a=n;a<i;a+=n){let n=e[a],i=e[a+1];n<s&&(s=n),i<c&&(c=i),n>t&&(t=n),i>r&&(r=i)}l=Math.max(t-s,r-c),l=l===0?0:32767/l}return uh(a,o,n,s,c,l,0),o}function ch(e,t,n,r,i){let a;if(i===zh(e,t,n,r)>0)for(let i=t;i<n;i+=r)a=Ih(i/r|0,e[i],e[i+1],a);else for(let i=n-r;i>=t;i-=r)a=Ih(i/r|0,e[i],e[i+1],a);return a&&Oh(a,a.next)&&(Lh(a),a=a.next),a}function lh(e,t){if(!e)return e;t||=e;let n=e,r;do if(r=!1,!n.steiner&&(Oh(n,n.next)||Dh(n.prev,n,n.next)===0)){if(Lh(n),n=t=n.prev,n===n.next)break;r=!0}else n=n.next;while(r||n!==t);return t}function uh(e,t,n,r,i,a,o){if(!e)return;!o&&a&&bh(e,r,i,a);let s=e;for(;e.prev!==e.next;){let c=e.prev,l=e.next;if(a?fh(e,r,i,a):dh(e))t.push(c.i,e.i,l.i),Lh(e),e=l.next,s=l.next;else if(e=l,e===s){o?o===1?(e=ph(lh(e),t),uh(e,t,n,r,i,a,2)):o===2&&mh(e,t,n,r,i,a):uh(lh(e),t,n,r,i,a,1);break}}}function dh(e){let t=e.prev,n=e,r=e.next;if(Dh(t,n,r)>=0)return!1;let i=t.x,a=n.x,o=r.x,s=t.y,c=n.y,l=r.y,u=Math.min(i,a,o),d=Math.min(s,c,l),f=Math.max(i,a,o),p=Math.max(s,c,l),m=r.next;for(;m!==t;){if(m.x>=u&&m.x<=f&&m.y>=d&&m.y<=p&&Th(i,s,a,c,o,l,m.x,m.y)&&Dh(m.prev,m,m.next)>=0)return!1;m=m.next}return!0}function fh(e,t,n,r){let i=e.prev,a=e,o=e.next;if(Dh(i,a,o)>=0)return!1;let s=i.x,c=a.x,l=o.x,u=i.y,d=a.y,f=o.y,p=Math.min(s,c,l),m=Math.min(u,d,f),h=Math.max(s,c,l),g=Math.max(u,d,f),_=Sh(p,m,t,n,r),v=Sh(h,g,t,n,r),y=e.prevZ,b=e.nextZ;for(;y&&y.z>=_&&b&&b.z<=v;){if(y.x>=p&&y.x<=h&&y.y>=m&&y.y<=g&&y!==i&&y!==o&&Th(s,u,c,d,l,f,y.x,y.y)&&Dh(y.prev,y,y.next)>=0||(y=y.prevZ,b.x>=p&&b.x<=h&&b.y>=m&&b.y<=g&&b!==i&&b!==o&&Th(s,u,c,d,l,f,b.x,b.y)&&Dh(b.prev,b,b.next)>=0))return!1;b=b.nextZ}for(;y&&y.z>=_;){if(y.x>=p&&y.x<=h&&y.y>=m&&y.y<=g&&y!==i&&y!==o&&Th(s,u,c,d,l,f,y.x,y.y)&&Dh(y.prev,y,y.next)>=0)return!1;y=y.prevZ}for(;b&&b.z<=v;){if(b.x>=p&&b.x<=h&&b.y>=m&&b.y<=g&&b!==i&&b!==o&&Th(s,u,c,d,l,f,b.x,b.y)&&Dh(b.prev,b,b.next)>=0)return!1;b=b.nextZ}return!0}function ph(e,t){let n=e;do{let r=n.prev,i=n.next.next;!Oh(r,i)&&kh(r,n,n.next,i)&&Nh(r,i)&&Nh(i,r)&&(t.push(r.i,n.i,i.i),Lh(n),Lh(n.next),n=e=i),n=n.next}while(n!==e);return lh(n)}function mh(e,t,n,r,i,a){let o=e;do{let e=o.next.next;for(;e!==o.prev;){if(o.i!==e.i&&Eh(o,e)){let s=Fh(o,e);o=lh(o,o.next),s=lh(s,s.next),uh(o,t,n,r,i,a,0),uh(s,t,n,r,i,a,0);return}e=e.next}o=o.next}while(o!==e)}function hh(e,t,n,r){let i=[];for(let n=0,a=t.length;n<a;n++){let o=ch(e,t[n]*r,n<a-1?t[n+1]*r:e.length,r,!1);o===o.next&&(o.steiner=!0),i.push(Ch(o))}i.sort(gh);for(let e=0;e<i.length;e++)n=_h(i[e],n);return n}function gh(e,t){let n=e.x-t.x;return n===0&&(n=e.y-t.y,n===0&&(n=(e.next.y-e.y)/(e.next.x-e.x)-(t.next.y-t.y)/(t.next.x-t.x))),n}function _h(e,t){let n=vh(e,t);if(!n)return t;let r=Fh(n,e);return lh(r,r.next),lh(n,n.next)}function vh(e,t){let n=t,r=e.x,i=e.y,a=-1/0,o;if(Oh(e,n))return n;do{if(Oh(e,n.next))return n.next;if(i<=n.y&&i>=n.next.y&&n.next.y!==n.y){let e=n.x+(i-n.y)*(n.next.x-n.x)/(n.next.y-n.y);if(e<=r&&e>a&&(a=e,o=n.x<n.next.x?n:n.next,e===r))return o}n=n.next}while(n!==t);if(!o)return null;let s=o,c=o.x,l=o.y,u=1/0;n=o;do{if(r>=n.x&&n.x>=c&&r!==n.x&&wh(i<l?r:a,i,c,l,i<l?a:r,i,n.x,n.y)){let t=Math.abs(i-n.y)/(r-n.x);Nh(n,e)&&(t<u||t===u&&(n.x>o.x||n.x===o.x&&yh(o,n)))&&(o=n,u=t)}n=n.next}while(n!==s);return o}function yh(e,t){return Dh(e.prev,e,t.prev)<0&&Dh(t.next,e,e.next)<0}function bh(e,t,n,r){let i=e;do i.z===0&&(i.z=Sh(i.x,i.y,t,n,r)),i.prevZ=i.prev,i.nextZ=i.next,i=i.next;while(i!==e);i.prevZ.nextZ=null,i.prevZ=null,xh(i)}function xh(e){let t,n=1;do{let r=e,i;e=null;let a=null;for(t=0;r;){t++;let o=r,s=0;for(let e=0;e<n&&(s++,o=o.nextZ,o);e++);let c=n;for(;s>0||c>0&&o;)s!==0&&(c===0||!o||r.z<=o.z)?(i=r,r=r.nextZ,s--):(i=o,o=o.nextZ,c--),a?a.nextZ=i:e=i,i.prevZ=a,a=i;r=o}a.nextZ=null,n*=2}while(t>1);return e}function Sh(e,t,n,r,i){return e=(e-n)*i|0,t=(t-r)*i|0,e=(e|e<<8)&16711935,e=(e|e<<4)&252645135,e=(e|e<<2)&858993459,e=(e|e<<1)&1431655765,t=(t|t<<8)&16711935,t=(t|t<<4)&252645135,t=(t|t<<2)&858993459,t=(t|t<<1)&1431655765,e|t<<1}function Ch(e){let t=e,n=e;do(t.x<n.x||t.x===n.x&&t.y<n.y)&&(n=t),t=t.next;while(t!==e);return n}function wh(e,t,n,r,i,a,o,s){return(i-o)*(t-s)>=(e-o)*(a-s)&&(e-o)*(r-s)>=(n-o)*(t-s)&&(n-o)*(a-s)>=(i-o)*(r-s)}function Th(e,t,n,r,i,a,o,s){return(e!==o||t!==s)&&wh(e,t,n,r,i,a,o,s)}function Eh(e,t){return e.next.i!==t.i&&e.prev.i!==t.i&&!Mh(e,t)&&(Nh(e,t)&&Nh(t,e)&&Ph(e,t)&&(Dh(e.prev,e,t.prev)||Dh(e,t.prev,t))||Oh(e,t)&&Dh(e.prev,e,e.next)>0&&Dh(t.prev,t,t.next)>0)}function Dh(e,t,n){return(t.y-e.y)*(n.x-t.x)-(t.x-e.x)*(n.y-t.y)}function Oh(e,t){return e.x===t.x&&e.y===t.y}function kh(e,t,n,r){let i=jh(Dh(e,t,n)),a=jh(Dh(e,t,r)),o=jh(Dh(n,r,e)),s=jh(Dh(n,r,t));return!!(i!==a&&o!==s||i===0&&Ah(e,n,t)||a===0&&Ah(e,r,t)||o===0&&Ah(n,e,r)||s===0&&Ah(n,t,r))}function Ah(e,t,n){return t.x<=Math.max(e.x,n.x)&&t.x>=Math.min(e.x,n.x)&&t.y<=Math.max(e.y,n.y)&&t.y>=Math.min(e.y,n.y)}function jh(e){return e>0?1:e<0?-1:0}function Mh(e,t){let n=e;do{if(n.i!==e.i&&n.next.i!==e.i&&n.i!==t.i&&n.next.i!==t.i&&kh(n,n.next,e,t))return!0;n=n.next}while(n!==e);return!1}function Nh(e,t){return Dh(e.prev,e,e.next)<0?Dh(e,t,e.next)>=0&&Dh(e,e.prev,t)>=0:Dh(e,t,e.prev)<0||Dh(e,e.next,t)<0}function Ph(e,t){let n=e,r=!1,i=(e.x+t.x)/2,a=(e.y+t.y)/2;do n.y>a!=n.next.y>a&&n.next.y!==n.y&&i<(n.next.x-n.x)*(a-n.y)/(n.next.y-n.y)+n.x&&(r=!r),n=n.next;while(n!==e);return r}function Fh(e,t){let n=Rh(e.i,e.x,e.y),r=Rh(t.i,t.x,t.y),i=e.next,a=t.prev;return e.next=t,t.prev=e,n.next=i,i.prev=n,r.next=n,n.prev=r,a.next=r,r.prev=a,r}function Ih(e,t,n,r){let i=Rh(e,t,n);return r?(i.next=r.next,i.prev=r,r.next.prev=i,r.next=i):(i.prev=i,i.next=i),i}function Lh(e){e.next.prev=e.prev,e.prev.next=e.next,e.prevZ&&(e.prevZ.nextZ=e.nextZ),e.nextZ&&(e.nextZ.prevZ=e.prevZ)}function Rh(e,t,n){return{i:e,x:t,y:n,prev:null,next:null,z:0,prevZ:null,nextZ:null,steiner:!1}}function zh(e,t,n,r){let i=0;for(let a=t,o=n-r;a<n;a+=r)i+=(e[o]-e[a])*(e[a+1]+e[o+1]),o=a;return i}var Bh=class{static triangulate(e,t,n=2){return sh(e,t,n)}},Vh=class e{static area(e){let t=e.length,n=0;for(let r=t-1,i=0;i<t;r=i++)n+=e[r].x*e[i].y-e[i].x*e[r].y;return n*.5}static isClockWise(t){return e.area(t)<0}static triangulateShape(e,t){let n=[],r=[],i=[];Hh(e),Uh(n,e);let a=e.length;t.forEach(Hh);for(let e=0;e<t.length;e++)r.push(a),a+=t[e].length,Uh(n,t[e]);let o=Bh.triangulate(n,r);for(let e=0;e<o.length;e+=3)i.push(o.slice(e,e+3));return i}};function Hh(e){let t=e.length;t>2&&e[t-1].equals(e[0])&&e.pop()}function Uh(e,t){for(let n=0;n<t.length;n++)e.push(t[n].x),e.push(t[n].y)}var Wh=class e extends lp{constructor(e=new oh([new Y(.5,.5),new Y(-.5,.5),new Y(-.5,-.5),new Y(.5,-.5)]),t={}){super(),this.type=`ExtrudeGeometry`,this.parameters={shapes:e,options:t},e=Array.isArray(e)?e:[e];let n=this,r=[],i=[];for(let t=0,n=e.length;t<n;t++){let n=e[t];a(n)}this.setAttribute(`position`,new Q(r,3)),this.setAttribute(`uv`,new Q(i,2)),this.computeVertexNormals();function a(e){let a=[],o=t.curveSegments===void 0?12:t.curveSegments,s=t.steps===void 0?1:t.steps,c=t.depth===void 0?1:t.depth,l=t.bevelEnabled===void 0||t.bevelEnabled,u=t.bevelThickness===void 0?.2:t.bevelThickness,d=t.bevelSize===void 0?u-.1:t.bevelSize,f=t.bevelOffset===void 0?0:t.bevelOffset,p=t.bevelSegments===void 0?3:t.bevelSegments,m=t.extrudePath,h=t.UVGenerator===void 0?Gh:t.UVGenerator,g,_=!1,v,y,b,x;if(m){g=m.getSpacedPoints(s),_=!0,l=!1;let e=m.isCatmullRomCurve3?m.closed:!1;v=m.computeFrenetFrames(s,e),y=new X,b=new X,x=new X}l||(p=0,u=0,d=0,f=0);let S=e.extractPoints(o),C=S.shape,w=S.holes;if(!Vh.isClockWise(C)){C=C.reverse();for(let e=0,t=w.length;e<t;e++){let t=w[e];Vh.isClockWise(t)&&(w[e]=t.reverse())}}function T(e){let t=e[0];for(let n=1;n<=e.length;n++){let r=n%e.length,i=e[r],a=i.x-t.x,o=i.y-t.y,s=a*a+o*o,c=Math.max(Math.abs(i.x),Math.abs(i.y),Math.abs(t.x),Math.abs(t.y));s<=10000000000000001e-36*c*c?(e.splice(r,1),n--):t=i}}T(C),w.forEach(T);let E=w.length,D=C;for(let e=0;e<E;e++){let t=w[e];C=C.concat(t)}function O(e,t,n){return t||q(`ExtrudeGeometry: vec does not exist`),e.clone().addScaledVector(t,n)}let k=C.length;function A(e,t,n){let r,i,a,o=e.x-t.x,s=e.y-t.y,c=n.x-e.x,l=n.y-e.y,u=o*o+s*s,d=o*l-s*c;if(Math.abs(d)>2**-52){let d=Math.sqrt(u),f=Math.sqrt(c*c+l*l),p=t.x-s/d,m=t.y+o/d,h=n.x-l/f,g=n.y+c/f,_=((h-p)*l-(g-m)*c)/(o*l-s*c);r=p+o*_-e.x,i=m+s*_-e.y;let v=r*r+i*i;if(v<=2)return new Y(r,i);a=Math.sqrt(v/2)}else{let e=!1;o>2**-52?c>2**-52&&(e=!0):o<-(2**-52)?c<-(2**-52)&&(e=!0):Math.sign(s)===Math.sign(l)&&(e=!0),e?(r=-s,i=o,a=Math.sqrt(u)):(r=o,i=s,a=Math.sqrt(u/2))}return new Y(r/a,i/a)}let j=[];for(let e=0,t=D.length,n=t-1,r=e+1;e<t;e++,n++,r++)n===t&&(n=0),r===t&&(r=0),j[e]=A(D[e],D[n],D[r]);let M=[],N,ee=j.concat();for(let e=0,t=E;e<t;e++){let t=w[e];N=[];for(let e=0,n=t.length,r=n-1,i=e+1;e<n;e++,r++,i++)r===n&&(r=0),i===n&&(i=0),N[e]=A(t[e],t[r],t[i]);M.push(N),ee=ee.concat(N)}let te;if(p===0)te=Vh.triangulateShape(D,w);else{let e=[],t=[];for(let n=0;n<p;n++){let r=n/p,i=u*Math.cos(r*Math.PI/2),a=d*Math.sin(r*Math.PI/2)+f;for(let t=0,n=D.length;t<n;t++){let n=O(D[t],j[t],a);I(n.x,n.y,-i),r===0&&e.push(n)}for(let e=0,n=E;e<n;e++){let n=w[e];N=M[e];let o=[];for(let e=0,t=n.length;e<t;e++){let t=O(n[e],N[e],a);I(t.x,t.y,-i),r===0&&o.push(t)}r===0&&t.push(o)}}te=Vh.triangulateShape(e,t)}let ne=te.length,re=d+f;for(let e=0;e<k;e++){let t=l?O(C[e],ee[e],re):C[e];_?(b.copy(v.normals[0]).multiplyScalar(t.x),y.copy(v.binormals[0]).multiplyScalar(t.y),x.copy(g[0]).add(b).add(y),I(x.x,x.y,x.z)):I(t.x,t.y,0)}for(let e=1;e<=s;e++)for(let t=0;t<k;t++){let n=l?O(C[t],ee[t],re):C[t];_?(b.copy(v.normals[e]).multiplyScalar(n.x),y.copy(v.binormals[e]).multiplyScalar(n.y),x.copy(g[e]).add(b).add(y),I(x.x,x.y,x.z)):I(n.x,n.y,c/s*e)}for(let e=p-1;e>=0;e--){let t=e/p,n=u*Math.cos(t*Math.PI/2),r=d*Math.sin(t*Math.PI/2)+f;for(let e=0,t=D.length;e<t;e++){let t=O(D[e],j[e],r);I(t.x,t.y,c+n)}for(let e=0,t=w.length;e<t;e++){let t=w[e];N=M[e];for(let e=0,i=t.length;e<i;e++){let i=O(t[e],N[e],r);_?I(i.x,i.y+g[s-1].y,g[s-1].x+n):I(i.x,i.y,c+n)}}}P(),F();function P(){let e=r.length/3;if(l){let e=0,t=k*e;for(let e=0;e<ne;e++){let n=te[e];L(n[2]+t,n[1]+t,n[0]+t)}e=s+p*2,t=k*e;for(let e=0;e<ne;e++){let n=te[e];L(n[0]+t,n[1]+t,n[2]+t)}}else{for(let e=0;e<ne;e++){let t=te[e];L(t[2],t[1],t[0])}for(let e=0;e<ne;e++){let t=te[e];L(t[0]+k*s,t[1]+k*s,t[2]+k*s)}}n.addGroup(e,r.length/3-e,0)}function F(){let e=r.length/3,t=0;ie(D,t),t+=D.length;for(let e=0,n=w.length;e<n;e++){let n=w[e];ie(n,t),t+=n.length}n.addGroup(e,r.length/3-e,1)}function ie(e,t){let n=e.length;for(;--n>=0;){let r=n,i=n-1;i<0&&(i=e.length-1);for(let e=0,n=s+p*2;e<n;e++){let n=k*e,a=k*(e+1);R(t+r+n,t+i+n,t+i+a,t+r+a)}}}function I(e,t,n){a.push(e),a.push(t),a.push(n)}function L(e,t,i){z(e),z(t),z(i);let a=r.length/3,o=h.generateTopUV(n,r,a-3,a-2,a-1);ae(o[0]),ae(o[1]),ae(o[2])}function R(e,t,i,a){z(e),z(t),z(a),z(t),z(i),z(a);let o=r.length/3,s=h.generateSideWallUV(n,r,o-6,o-3,o-2,o-1);ae(s[0]),ae(s[1]),ae(s[3]),ae(s[1]),ae(s[2]),ae(s[3])}function z(e){r.push(a[e*3+0]),r.push(a[e*3+1]),r.push(a[e*3+2])}function ae(e){i.push(e.x),i.push(e.y)}}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}toJSON(){let e=super.toJSON(),t=this.parameters.shapes,n=this.parameters.options;return Kh(t,n,e)}static fromJSON(t,n){let r=[];for(let e=0,i=t.shapes.length;e<i;e++){let i=n[t.shapes[e]];r.push(i)}let i=t.options.extrudePath;return i!==void 0&&(t.options.extrudePath=new rh[i.type]().fromJSON(i)),new e(r,t.options)}},Gh={generateTopUV:function(e,t,n,r,i){let a=t[n*3],o=t[n*3+1],s=t[r*3],c=t[r*3+1],l=t[i*3],u=t[i*3+1];return[new Y(a,o),new Y(s,c),new Y(l,u)]},generateSideWallUV:function(e,t,n,r,i,a){let o=t[n*3],s=t[n*3+1],c=t[n*3+2],l=t[r*3],u=t[r*3+1],d=t[r*3+2],f=t[i*3],p=t[i*3+1],m=t[i*3+2],h=t[a*3],g=t[a*3+1],_=t[a*3+2];return Math.abs(s-u)<Math.abs(o-l)?[new Y(o,1-c),new Y(l,1-d),new Y(f,1-m),new Y(h,1-_)]:[new Y(s,1-c),new Y(u,1-d),new Y(p,1-m),new Y(g,1-_)]}};function Kh(e,t,n){if(n.shapes=[],Array.isArray(e))for(let t=0,r=e.length;t<r;t++){let r=e[t];n.shapes.push(r.uuid)}else n.shapes.push(e.uuid);return n.options=Object.assign({},t),t.extrudePath!==void 0&&(n.options.extrudePath=t.extrudePath.toJSON()),n}var qh=class e extends lp{constructor(e=[new Y(0,-.5),new Y(.5,0),new Y(0,.5)],t=12,n=0,r=Math.PI*2){super(),this.type=`LatheGeometry`,this.parameters={points:e,segments:t,phiStart:n,phiLength:r},t=Math.floor(t),r=J(r,0,Math.PI*2);let i=[],a=[],o=[],s=[],c=[],l=1/t,u=new X,d=new Y,f=new X,p=new X,m=new X,h=0,g=0;for(let t=0;t<=e.length-1;t++)switch(t){case 0:h=e[t+1].x-e[t].x,g=e[t+1].y-e[t].y,f.x=g*1,f.y=-h,f.z=g*0,m.copy(f),f.normalize(),s.push(f.x,f.y,f.z);break;case e.length-1:m.normalize(),s.push(m.x,m.y,m.z);break;default:h=e[t+1].x-e[t].x,g=e[t+1].y-e[t].y,f.x=g*1,f.y=-h,f.z=g*0,p.copy(f),f.x+=m.x,f.y+=m.y,f.z+=m.z,f.normalize(),s.push(f.x,f.y,f.z),m.copy(p)}for(let i=0;i<=t;i++){let f=n+i*l*r,p=Math.sin(f),m=Math.cos(f);for(let n=0;n<=e.length-1;n++){u.x=e[n].x*p,u.y=e[n].y,u.z=e[n].x*m,a.push(u.x,u.y,u.z),d.x=i/t,d.y=n/(e.length-1),o.push(d.x,d.y);let r=s[3*n+0]*p,l=s[3*n+1],f=s[3*n+0]*m;c.push(r,l,f)}}for(let n=0;n<t;n++)for(let t=0;t<e.length-1;t++){let r=t+n*e.length,a=r,o=r+e.length,s=r+e.length+1,c=r+1;i.push(a,o,c),i.push(s,c,o)}this.setIndex(i),this.setAttribute(`position`,new Q(a,3)),this.setAttribute(`uv`,new Q(o,2)),this.setAttribute(`normal`,new Q(c,3))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.points,t.segments,t.phiStart,t.phiLength)}},Jh=class e extends wm{constructor(e=1,t=0){super([1,0,0,-1,0,0,0,1,0,0,-1,0,0,0,1,0,0,-1],[0,2,4,0,4,3,0,3,5,0,5,2,1,2,5,1,5,3,1,3,4,1,4,2],e,t),this.type=`OctahedronGeometry`,this.parameters={radius:e,detail:t}}static fromJSON(t){return new e(t.radius,t.detail)}},Yh=class e extends lp{constructor(e=1,t=1,n=1,r=1){super(),this.type=`PlaneGeometry`,this.parameters={width:e,height:t,widthSegments:n,heightSegments:r};let i=e/2,a=t/2,o=Math.floor(n),s=Math.floor(r),c=o+1,l=s+1,u=e/o,d=t/s,f=[],p=[],m=[],h=[];for(let e=0;e<l;e++){let t=e*d-a;for(let n=0;n<c;n++){let r=n*u-i;p.push(r,-t,0),m.push(0,0,1),h.push(n/o),h.push(1-e/s)}}for(let e=0;e<s;e++)for(let t=0;t<o;t++){let n=t+c*e,r=t+c*(e+1),i=t+1+c*(e+1),a=t+1+c*e;f.push(n,r,a),f.push(r,i,a)}this.setIndex(f),this.setAttribute(`position`,new Q(p,3)),this.setAttribute(`normal`,new Q(m,3)),this.setAttribute(`uv`,new Q(h,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.widthSegments,t.heightSegments)}},Xh=class e extends lp{constructor(e=new oh([new Y(0,.5),new Y(-.5,-.5),new Y(.5,-.5)]),t=12){super(),this.type=`ShapeGeometry`,this.parameters={shapes:e,curveSegments:t};let n=[],r=[],i=[],a=[],o=0,s=0;if(Array.isArray(e)===!1)c(e);else for(let t=0;t<e.length;t++)c(e[t]),this.addGroup(o,s,t),o+=s,s=0;this.setIndex(n),this.setAttribute(`position`,new Q(r,3)),this.setAttribute(`normal`,new Q(i,3)),this.setAttribute(`uv`,new Q(a,2));function c(e){let o=r.length/3,c=e.extractPoints(t),l=c.shape,u=c.holes;Vh.isClockWise(l)===!1&&(l=l.reverse());for(let e=0,t=u.length;e<t;e++){let t=u[e];Vh.isClockWise(t)===!0&&(u[e]=t.reverse())}let d=Vh.triangulateShape(l,u);for(let e=0,t=u.length;e<t;e++){let t=u[e];l=l.concat(t)}for(let e=0,t=l.length;e<t;e++){let t=l[e];r.push(t.x,t.y,0),i.push(0,0,1),a.push(t.x,t.y)}for(let e=0,t=d.length;e<t;e++){let t=d[e],r=t[0]+o,i=t[1]+o,a=t[2]+o;n.push(r,i,a),s+=3}}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}toJSON(){let e=super.toJSON(),t=this.parameters.shapes;return Zh(t,e)}static fromJSON(t,n){let r=[];for(let e=0,i=t.shapes.length;e<i;e++){let i=n[t.shapes[e]];r.push(i)}return new e(r,t.curveSegments)}};function Zh(e,t){if(t.shapes=[],Array.isArray(e))for(let n=0,r=e.length;n<r;n++){let r=e[n];t.shapes.push(r.uuid)}else t.shapes.push(e.uuid);return t}var Qh=class e extends lp{constructor(e=1,t=32,n=16,r=0,i=Math.PI*2,a=0,o=Math.PI){super(),this.type=`SphereGeometry`,this.parameters={radius:e,widthSegments:t,heightSegments:n,phiStart:r,phiLength:i,thetaStart:a,thetaLength:o},t=Math.max(3,Math.floor(t)),n=Math.max(2,Math.floor(n));let s=Math.min(a+o,Math.PI),c=0,l=[],u=new X,d=new X,f=[],p=[],m=[],h=[];for(let f=0;f<=n;f++){let g=[],_=f/n,v=a+_*o,y=e*Math.cos(v),b=Math.sqrt(e*e-y*y),x=0;f===0&&a===0?x=.5/t:f===n&&s===Math.PI&&(x=-.5/t);for(let e=0;e<=t;e++){let n=e/t,a=r+n*i;u.x=-b*Math.cos(a),u.y=y,u.z=b*Math.sin(a),p.push(u.x,u.y,u.z),d.copy(u).normalize(),m.push(d.x,d.y,d.z),h.push(n+x,1-_),g.push(c++)}l.push(g)}for(let e=0;e<n;e++)for(let r=0;r<t;r++){let t=l[e][r+1],i=l[e][r],o=l[e+1][r],c=l[e+1][r+1];(e!==0||a>0)&&f.push(t,i,c),(e!==n-1||s<Math.PI)&&f.push(i,o,c)}this.setIndex(f),this.setAttribute(`position`,new Q(p,3)),this.setAttribute(`normal`,new Q(m,3)),this.setAttribute(`uv`,new Q(h,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.radius,t.widthSegments,t.heightSegments,t.phiStart,t.phiLength,t.thetaStart,t.thetaLength)}},$h=class e extends lp{constructor(e=1,t=.4,n=12,r=48,i=Math.PI*2,a=0,o=Math.PI*2){super(),this.type=`TorusGeometry`,this.parameters={radius:e,tube:t,radialSegments:n,tubularSegments:r,arc:i,thetaStart:a,thetaLength:o},n=Math.floor(n),r=Math.floor(r);let s=[],c=[],l=[],u=[],d=new X,f=new X,p=new X;for(let s=0;s<=n;s++){let m=a+s/n*o;for(let a=0;a<=r;a++){let o=a/r*i;f.x=(e+t*Math.cos(m))*Math.cos(o),f.y=(e+t*Math.cos(m))*Math.sin(o),f.z=t*Math.sin(m),c.push(f.x,f.y,f.z),d.x=e*Math.cos(o),d.y=e*Math.sin(o),p.subVectors(f,d).normalize(),l.push(p.x,p.y,p.z),u.push(a/r),u.push(s/n)}}for(let e=1;e<=n;e++)for(let t=1;t<=r;t++){let n=(r+1)*e+t-1,i=(r+1)*(e-1)+t-1,a=(r+1)*(e-1)+t,o=(r+1)*e+t;s.push(n,i,o),s.push(i,a,o)}this.setIndex(s),this.setAttribute(`position`,new Q(c,3)),this.setAttribute(`normal`,new Q(l,3)),this.setAttribute(`uv`,new Q(u,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.radius,t.tube,t.radialSegments,t.tubularSegments,t.arc,t.thetaStart,t.thetaLength)}},eg=class e extends lp{constructor(e=new th(new X(-1,-1,0),new X(-1,1,0),new X(1,1,0)),t=64,n=1,r=8,i=!1){super(),this.type=`TubeGeometry`,this.parameters={path:e,tubularSegments:t,radius:n,radialSegments:r,closed:i};let a=e.computeFrenetFrames(t,i);this.tangents=a.tangents,this.normals=a.normals,this.binormals=a.binormals;let o=new X,s=new X,c=new Y,l=new X,u=[],d=[],f=[],p=[];m(),this.setIndex(p),this.setAttribute(`position`,new Q(u,3)),this.setAttribute(`normal`,new Q(d,3)),this.setAttribute(`uv`,new Q(f,2));function m(){for(let e=0;e<t;e++)h(e);h(i===!1?t:0),_(),g()}function h(i){l=e.getPointAt(i/t,l);let c=a.normals[i],f=a.binormals[i];for(let e=0;e<=r;e++){let t=e/r*Math.PI*2,i=Math.sin(t),a=-Math.cos(t);s.x=a*c.x+i*f.x,s.y=a*c.y+i*f.y,s.z=a*c.z+i*f.z,s.normalize(),d.push(s.x,s.y,s.z),o.x=l.x+n*s.x,o.y=l.y+n*s.y,o.z=l.z+n*s.z,u.push(o.x,o.y,o.z)}}function g(){for(let e=1;e<=t;e++)for(let t=1;t<=r;t++){let n=(r+1)*(e-1)+(t-1),i=(r+1)*e+(t-1),a=(r+1)*e+t,o=(r+1)*(e-1)+t;p.push(n,i,o),p.push(i,a,o)}}function _(){for(let e=0;e<=t;e++)for(let n=0;n<=r;n++)c.x=e/t,c.y=n/r,f.push(c.x,c.y)}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}toJSON(){let e=super.toJSON();return e.path=this.parameters.path.toJSON(),e}static fromJSON(t){return new e(new rh[t.path.type]().fromJSON(t.path),t.tubularSegments,t.radius,t.radialSegments,t.closed)}},tg=class extends lp{constructor(e=null){if(super(),this.type=`WireframeGeometry`,this.parameters={geometry:e},e!==null){let t=[],n=new Set,r=new X,i=new X;if(e.index!==null){let a=e.attributes.position,o=e.index,s=e.groups;s.length===0&&(s=[{start:0,count:o.count,materialIndex:0}]);for(let e=0,c=s.length;e<c;++e){let c=s[e],l=c.start,u=c.count;for(let e=l,s=l+u;e<s;e+=3)for(let s=0;s<3;s++){let c=o.getX(e+s),l=o.getX(e+(s+1)%3);r.fromBufferAttribute(a,c),i.fromBufferAttribute(a,l),ng(r,i,n)===!0&&(t.push(r.x,r.y,r.z),t.push(i.x,i.y,i.z))}}}else{let a=e.attributes.position;for(let e=0,o=a.count/3;e<o;e++)for(let o=0;o<3;o++){let s=3*e+o,c=3*e+(o+1)%3;r.fromBufferAttribute(a,s),i.fromBufferAttribute(a,c),ng(r,i,n)===!0&&(t.push(r.x,r.y,r.z),t.push(i.x,i.y,i.z))}}this.setAttribute(`position`,new Q(t,3))}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}};function ng(e,t,n){let r=`${e.x},${e.y},${e.z}-${t.x},${t.y},${t.z}`,i=`${t.x},${t.y},${t.z}-${e.x},${e.y},${e.z}`;return n.has(r)===!0||n.has(i)===!0?!1:(n.add(r),n.add(i),!0)}var rg=class extends yp{constructor(e){super(),this.isShadowMaterial=!0,this.type=`ShadowMaterial`,this.color=new Z(0),this.transparent=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.fog=e.fog,this}};function ig(e){let t={};for(let n in e){t[n]={};for(let r in e[n]){let i=e[n][r];if(og(i))i.isRenderTargetTexture?(K(`UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms().`),t[n][r]=null):t[n][r]=i.clone();else if(Array.isArray(i)){if(og(i[0])){let e=[];for(let t=0,n=i.length;t<n;t++)e[t]=i[t].clone();t[n][r]=e}else t[n][r]=i.slice()}else t[n][r]=i}}return t}function ag(e){let t={};for(let n=0;n<e.length;n++){let r=ig(e[n]);for(let e in r)t[e]=r[e]}return t}function og(e){return e&&(e.isColor||e.isMatrix3||e.isMatrix4||e.isVector2||e.isVector3||e.isVector4||e.isTexture||e.isQuaternion)}function sg(e){let t=[];for(let n=0;n<e.length;n++)t.push(e[n].clone());return t}function cg(e){let t=e.getRenderTarget();return t===null?e.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:_d.workingColorSpace}var lg={clone:ig,merge:ag},ug=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,dg=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,fg=class extends yp{constructor(e){super(),this.isShaderMaterial=!0,this.type=`ShaderMaterial`,this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=ug,this.fragmentShader=dg,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=ig(e.uniforms),this.uniformsGroups=sg(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let n in this.uniforms){let r=this.uniforms[n].value;r&&r.isTexture?t.uniforms[n]={type:`t`,value:r.toJSON(e).uuid}:r&&r.isColor?t.uniforms[n]={type:`c`,value:r.getHex()}:r&&r.isVector2?t.uniforms[n]={type:`v2`,value:r.toArray()}:r&&r.isVector3?t.uniforms[n]={type:`v3`,value:r.toArray()}:r&&r.isVector4?t.uniforms[n]={type:`v4`,value:r.toArray()}:r&&r.isMatrix3?t.uniforms[n]={type:`m3`,value:r.toArray()}:r&&r.isMatrix4?t.uniforms[n]={type:`m4`,value:r.toArray()}:t.uniforms[n]={value:r}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let e in this.extensions)this.extensions[e]===!0&&(n[e]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let r=e.uniforms[n];switch(this.uniforms[n]={},r.type){case`t`:this.uniforms[n].value=t[r.value]||null;break;case`c`:this.uniforms[n].value=new Z().setHex(r.value);break;case`v2`:this.uniforms[n].value=new Y().fromArray(r.value);break;case`v3`:this.uniforms[n].value=new X().fromArray(r.value);break;case`v4`:this.uniforms[n].value=new Od().fromArray(r.value);break;case`m3`:this.uniforms[n].value=new fd().fromArray(r.value);break;case`m4`:this.uniforms[n].value=new Nd().fromArray(r.value);break;default:this.uniforms[n].value=r.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let t in e.extensions)this.extensions[t]=e.extensions[t];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},pg=class extends fg{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type=`RawShaderMaterial`}},mg=class extends yp{constructor(e){super(),this.isMeshStandardMaterial=!0,this.type=`MeshStandardMaterial`,this.defines={STANDARD:``},this.color=new Z(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new Z(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=0,this.normalScale=new Y(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Ud,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.defines={STANDARD:``},this.color.copy(e.color),this.roughness=e.roughness,this.metalness=e.metalness,this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.roughnessMap=e.roughnessMap,this.metalnessMap=e.metalnessMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.envMapIntensity=e.envMapIntensity,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}},hg=class extends yp{constructor(e){super(),this.isMeshLambertMaterial=!0,this.type=`MeshLambertMaterial`,this.color=new Z(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new Z(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=0,this.normalScale=new Y(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Ud,this.combine=0,this.reflectivity=1,this.envMapIntensity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.envMapIntensity=e.envMapIntensity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}},gg=class extends yp{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type=`MeshDepthMaterial`,this.depthPacking=_u,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},_g=class extends yp{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type=`MeshDistanceMaterial`,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function vg(e,t){return!e||e.constructor===t?e:typeof t.BYTES_PER_ELEMENT==`number`?new t(e):Array.prototype.slice.call(e)}function yg(e){return e!==void 0&&e.inTangents!==void 0&&e.outTangents!==void 0}function bg(e){function t(t,n){return e[t]-e[n]}let n=e.length,r=Array(n);for(let e=0;e!==n;++e)r[e]=e;return r.sort(t),r}function xg(e,t,n){let r=e.length,i=new e.constructor(r);for(let a=0,o=0;o!==r;++a){let r=n[a]*t;for(let n=0;n!==t;++n)i[o++]=e[r+n]}return i}function Sg(e,t,n,r){let i=1,a=e[0];for(;a!==void 0&&a[r]===void 0;)a=e[i++];if(a===void 0)return;let o=a[r];if(o!==void 0){if(Array.isArray(o))do o=a[r],o!==void 0&&(t.push(a.time),n.push(...o)),a=e[i++];while(a!==void 0);else if(o.toArray!==void 0)do o=a[r],o!==void 0&&(t.push(a.time),o.toArray(n,n.length)),a=e[i++];while(a!==void 0);else do o=a[r],o!==void 0&&(t.push(a.time),n.push(o)),a=e[i++];while(a!==void 0)}}var Cg=class{constructor(e,t,n,r){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=r===void 0?new t.constructor(n):r,this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,r=t[n],i=t[n-1];validate_interval:{seek:{let a;linear_scan:{forward_scan:if(!(e<r)){for(let a=n+2;;){if(r===void 0){if(e<i)break forward_scan;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(i=r,r=t[++n],e<r)break seek}a=t.length;break linear_scan}if(!(e>=i)){let o=t[1];e<o&&(n=2,i=o);for(let a=n-2;;){if(i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===a)break;if(r=i,i=t[--n-1],e>=i)break seek}a=n,n=0;break linear_scan}break validate_interval}for(;n<a;){let r=n+a>>>1;e<t[r]?a=r:n=r+1}if(r=t[n],i=t[n-1],i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(r===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,i,r)}return this.interpolate_(n,i,e,r)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,r=this.valueSize,i=e*r;for(let e=0;e!==r;++e)t[e]=n[i+e];return t}interpolate_(){throw Error(`THREE.Interpolant: Call to abstract method.`)}intervalChanged_(){}},wg=class extends Cg{constructor(e,t,n,r){super(e,t,n,r),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:pu,endingEnd:pu}}intervalChanged_(e,t,n){let r=this.parameterPositions,i=e-2,a=e+1,o=r[i],s=r[a];if(o===void 0)switch(this.getSettings_().endingStart){case mu:i=e,o=2*t-n;break;case hu:i=r.length-2,o=t+r[i]-r[i+1];break;default:i=e,o=n}if(s===void 0)switch(this.getSettings_().endingEnd){case mu:a=e,s=2*n-t;break;case hu:a=1,s=n+r[1]-r[0];break;default:a=e-1,s=t}let c=(n-t)*.5,l=this.valueSize;this._weightPrev=c/(t-o),this._weightNext=c/(s-n),this._offsetPrev=i*l,this._offsetNext=a*l}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this._offsetPrev,u=this._offsetNext,d=this._weightPrev,f=this._weightNext,p=(n-t)/(r-t),m=p*p,h=m*p,g=-d*h+2*d*m-d*p,_=(1+d)*h+(-1.5-2*d)*m+(-.5+d)*p+1,v=(-1-f)*h+(1.5+f)*m+.5*p,y=f*h-f*m;for(let e=0;e!==o;++e)i[e]=g*a[l+e]+_*a[c+e]+v*a[s+e]+y*a[u+e];return i}},Tg=class extends Cg{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=(n-t)/(r-t),u=1-l;for(let e=0;e!==o;++e)i[e]=a[c+e]*u+a[s+e]*l;return i}},Eg=class extends Cg{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e){return this.copySampleValue_(e-1)}},Dg=class extends Cg{interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this.inTangents,u=this.outTangents;if(!l||!u){let e=(n-t)/(r-t),l=1-e;for(let t=0;t!==o;++t)i[t]=a[c+t]*l+a[s+t]*e;return i}let d=o*2,f=e-1;for(let p=0;p!==o;++p){let o=a[c+p],m=a[s+p],h=f*d+p*2,g=u[h],_=u[h+1],v=e*d+p*2,y=l[v],b=l[v+1],x=Ag(n,t,g,y,r);i[p]=Og(x,o,_,b,m)}return i}};function Og(e,t,n,r,i){let a=1-e;return a*a*a*t+3*a*a*e*n+3*a*e*e*r+e*e*e*i}function kg(e,t,n,r,i){let a=1-e;return 3*a*a*(n-t)+6*a*e*(r-n)+3*e*e*(i-r)}function Ag(e,t,n,r,i){let a=(e-t)/(i-t);for(let o=0;o<8;o++){let o=Og(a,t,n,r,i)-e;if(Math.abs(o)<1e-10)break;let s=kg(a,t,n,r,i);if(Math.abs(s)<1e-10)break;a=Math.max(0,Math.min(1,a-o/s))}return a}var jg=class{constructor(e,t,n,r){if(e===void 0)throw Error(`THREE.KeyframeTrack: track name is undefined`);if(t===void 0||t.length===0)throw Error(`THREE.KeyframeTrack: no keyframes in track named `+e);this.name=e,this.times=vg(t,this.TimeBufferType),this.values=vg(n,this.ValueBufferType),this.setInterpolation(r||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:vg(e.times,Array),values:vg(e.values,Array)};let t=e.getInterpolation();t!==e.DefaultInterpolation&&(n.interpolation=t),yg(e.settings)&&(n.settings={inTangents:vg(e.settings.inTangents,Array),outTangents:vg(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new Eg(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new Tg(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new wg(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new Dg(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case lu:t=this.InterpolantFactoryMethodDiscrete;break;case uu:t=this.InterpolantFactoryMethodLinear;break;case du:t=this.InterpolantFactoryMethodSmooth;break;case fu:t=this.InterpolantFactoryMethodBezier}if(t===void 0){let t=`unsupported interpolation for `+this.ValueTypeName+` keyframe track named `+this.name;if(this.createInterpolant===void 0){if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw Error(t)}return K(`KeyframeTrack:`,t),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return lu;case this.InterpolantFactoryMethodLinear:return uu;case this.InterpolantFactoryMethodSmooth:return du;case this.InterpolantFactoryMethodBezier:return fu}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]+=e;yg(this.settings)&&(Mg(this.settings.inTangents,e),Mg(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]*=e;yg(this.settings)&&(Ng(this.settings.inTangents,e),Ng(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,r=n.length,i=0,a=r-1;for(;i!==r&&n[i]<e;)++i;for(;a!==-1&&n[a]>t;)--a;if(++a,i!==0||a!==r){i>=a&&(a=Math.max(a,1),i=a-1);let e=this.getValueSize();this.times=n.slice(i,a),this.values=this.values.slice(i*e,a*e)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(q(`KeyframeTrack: Invalid value size in track.`,this),e=!1);let n=this.times,r=this.values,i=n.length;i===0&&(q(`KeyframeTrack: Track is empty.`,this),e=!1);let a=null;for(let t=0;t!==i;t++){let r=n[t];if(typeof r==`number`&&isNaN(r)){q(`KeyframeTrack: Time is not a valid number.`,this,t,r),e=!1;break}if(a!==null&&a>r){q(`KeyframeTrack: Out of order keys.`,this,t,r,a),e=!1;break}a=r}if(r!==void 0&&Eu(r))for(let t=0,n=r.length;t!==n;++t){let n=r[t];if(isNaN(n)){q(`KeyframeTrack: Value is not a valid number.`,this,t,n),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),r=this.getInterpolation()===du,i=e.length-1,a=1;for(let o=1;o<i;++o){let i=!1,s=e[o];if(s!==e[o+1]&&(o!==1||s!==e[0])){if(r)i=!0;else{let e=o*n,r=e-n,a=e+n;for(let o=0;o!==n;++o){let n=t[e+o];if(n!==t[r+o]||n!==t[a+o]){i=!0;break}}}}if(i){if(o!==a){e[a]=e[o];let r=o*n,i=a*n;for(let e=0;e!==n;++e)t[i+e]=t[r+e]}++a}}if(i>0){e[a]=e[i];for(let e=i*n,r=a*n,o=0;o!==n;++o)t[r+o]=t[e+o];++a}return a===e.length?(this.times=e,this.values=t):(this.times=e.slice(0,a),this.values=t.slice(0,a*n)),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,r=new n(this.name,e,t);return r.createInterpolant=this.createInterpolant,yg(this.settings)&&(r.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),r}};function Mg(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]+=t}function Ng(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]*=t}jg.prototype.ValueTypeName=``,jg.prototype.TimeBufferType=Float32Array,jg.prototype.ValueBufferType=Float32Array,jg.prototype.DefaultInterpolation=uu;var Pg=class extends jg{constructor(e,t,n){super(e,t,n)}};Pg.prototype.ValueTypeName=`bool`,Pg.prototype.ValueBufferType=Array,Pg.prototype.DefaultInterpolation=lu,Pg.prototype.InterpolantFactoryMethodLinear=void 0,Pg.prototype.InterpolantFactoryMethodSmooth=void 0;var Fg=class extends jg{constructor(e,t,n,r){super(e,t,n,r)}};Fg.prototype.ValueTypeName=`color`;var Ig=class extends jg{constructor(e,t,n,r){super(e,t,n,r)}};Ig.prototype.ValueTypeName=`number`;var Lg=class extends Cg{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=(n-t)/(r-t),c=e*o;for(let e=c+o;c!==e;c+=4)ld.slerpFlat(i,0,a,c-o,a,c,s);return i}},Rg=class extends jg{constructor(e,t,n,r){super(e,t,n,r)}InterpolantFactoryMethodLinear(e){return new Lg(this.times,this.values,this.getValueSize(),e)}};Rg.prototype.ValueTypeName=`quaternion`,Rg.prototype.InterpolantFactoryMethodSmooth=void 0;var zg=class extends jg{constructor(e,t,n){super(e,t,n)}};zg.prototype.ValueTypeName=`string`,zg.prototype.ValueBufferType=Array,zg.prototype.DefaultInterpolation=lu,zg.prototype.InterpolantFactoryMethodLinear=void 0,zg.prototype.InterpolantFactoryMethodSmooth=void 0;var Bg=class extends jg{constructor(e,t,n,r){super(e,t,n,r)}};Bg.prototype.ValueTypeName=`vector`;var Vg=class{constructor(e=``,t=-1,n=[],r=gu){this.name=e,this.tracks=n,this.duration=t,this.blendMode=r,this.uuid=Bu(),this.userData={},this.duration<0&&this.resetDuration()}static parse(e){let t=[],n=e.tracks,r=1/(e.fps||1);for(let e=0,i=n.length;e!==i;++e)t.push(Ug(n[e]).scale(r));let i=new this(e.name,e.duration,t,e.blendMode);return i.uuid=e.uuid,i.userData=JSON.parse(e.userData||`{}`),i}static toJSON(e){let t=[],n=e.tracks,r={name:e.name,duration:e.duration,tracks:t,uuid:e.uuid,blendMode:e.blendMode,userData:JSON.stringify(e.userData)};for(let e=0,r=n.length;e!==r;++e)t.push(jg.toJSON(n[e]));return r}static CreateFromMorphTargetSequence(e,t,n,r){let i=t.length,a=[];for(let e=0;e<i;e++){let o=[],s=[];o.push((e+i-1)%i,e,(e+1)%i),s.push(0,1,0);let c=bg(o);o=xg(o,1,c),s=xg(s,1,c),!r&&o[0]===0&&(o.push(i),s.push(s[0])),a.push(new Ig(`.morphTargetInfluences[`+t[e].name+`]`,o,s).scale(1/n))}return new this(e,-1,a)}static findByName(e,t){let n=e;if(!Array.isArray(e)){let t=e;n=t.geometry&&t.geometry.animations||t.animations}for(let e=0;e<n.length;e++)if(n[e].name===t)return n[e];return null}static CreateClipsFromMorphTargetSequences(e,t,n){let r={},i=/^([\w-]*?)([\d]+)$/;for(let t=0,n=e.length;t<n;t++){let n=e[t],a=n.name.match(i);if(a&&a.length>1){let e=a[1],t=r[e];t||(r[e]=t=[]),t.push(n)}}let a=[];for(let e in r)a.push(this.CreateFromMorphTargetSequence(e,r[e],t,n));return a}resetDuration(){let e=this.tracks,t=0;for(let n=0,r=e.length;n!==r;++n){let e=this.tracks[n];t=Math.max(t,e.times[e.times.length-1])}return this.duration=t,this}trim(){for(let e=0;e<this.tracks.length;e++)this.tracks[e].trim(0,this.duration);return this}validate(){let e=!0;for(let t=0;t<this.tracks.length;t++)e&&=this.tracks[t].validate();return e}optimize(){for(let e=0;e<this.tracks.length;e++)this.tracks[e].optimize();return this}clone(){let e=[];for(let t=0;t<this.tracks.length;t++)e.push(this.tracks[t].clone());let t=new this.constructor(this.name,this.duration,e,this.blendMode);return t.userData=JSON.parse(JSON.stringify(this.userData)),t}toJSON(){return this.constructor.toJSON(this)}};function Hg(e){switch(e.toLowerCase()){case`scalar`:case`double`:case`float`:case`number`:case`integer`:return Ig;case`vector`:case`vector2`:case`vector3`:case`vector4`:return Bg;case`color`:return Fg;case`quaternion`:return Rg;case`bool`:case`boolean`:return Pg;case`string`:return zg}throw Error(`THREE.KeyframeTrack: Unsupported typeName: `+e)}function Ug(e){if(e.type===void 0)throw Error(`THREE.KeyframeTrack: track type undefined, can not parse`);let t=Hg(e.type);if(e.times===void 0){let t=[],n=[];Sg(e.keys,t,n,`value`),e.times=t,e.values=n}let n;return n=t.parse===void 0?new t(e.name,e.times,e.values,e.interpolation):t.parse(e),yg(e.settings)&&(n.settings={inTangents:vg(e.settings.inTangents,Float32Array),outTangents:vg(e.settings.outTangents,Float32Array)}),n}var Wg=class extends sf{static registerNode(e){this.prototype._lightNode=e}constructor(e,t=1){super(),this.isLight=!0,this.type=`Light`,this.color=new Z(e),this.intensity=t}copy(e,t){return super.copy(e,t),this.color.copy(e.color),this.intensity=e.intensity,this}toJSON(e){let t=super.toJSON(e);return t.object.color=this.color.getHex(),t.object.intensity=this.intensity,t}},Gg=class extends Wg{constructor(e,t,n){super(e,n),this.isHemisphereLight=!0,this.type=`HemisphereLight`,this.position.copy(sf.DEFAULT_UP),this.updateMatrix(),this.groundColor=new Z(t)}copy(e,t){return super.copy(e,t),this.groundColor.copy(e.groundColor),this}toJSON(e){let t=super.toJSON(e);return t.object.groundColor=this.groundColor.getHex(),t}},Kg=new Nd,qg=new X,Jg=new X,Yg=class{constructor(e){this.camera=e,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new Y(512,512),this.mapType=il,this.map=null,this.mapPass=null,this.matrix=new Nd,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new $p,this._frameExtents=new Y(1,1),this._viewportCount=1,this._viewports=[new Od(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(e){let t=this.camera;qg.setFromMatrixPosition(e.matrixWorld),t.position.copy(qg),Jg.setFromMatrixPosition(e.target.matrixWorld),t.lookAt(Jg),t.updateMatrixWorld(),this._updateMatrix(t,this.matrix,this._frustum)}_updateMatrix(e,t,n,r){Kg.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),n.setFromProjectionMatrix(Kg,e.coordinateSystem,e.reversedDepth);let i=this._frameExtents,a=r?r.z/i.x:1,o=r?r.w/i.y:1,s=r?r.x/i.x:0,c=r?r.y/i.y:0;e.coordinateSystem===2001||e.reversedDepth?t.set(.5*a,0,0,.5*a+s,0,.5*o,0,.5*o+c,0,0,1,0,0,0,0,1):t.set(.5*a,0,0,.5*a+s,0,.5*o,0,.5*o+c,0,0,.5,.5,0,0,0,1),t.multiply(Kg)}getViewport(e){return this._viewports[e]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(e){return this.camera=e.camera.clone(),this.intensity=e.intensity,this.bias=e.bias,this.radius=e.radius,this.autoUpdate=e.autoUpdate,this.needsUpdate=e.needsUpdate,this.normalBias=e.normalBias,this.blurSamples=e.blurSamples,this.mapSize.copy(e.mapSize),this.mapType=e.mapType,this.biasNode=e.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let e={};return e.intensity=this.intensity,e.bias=this.bias,e.normalBias=this.normalBias,e.radius=this.radius,e.blurSamples=this.blurSamples,e.mapSize=this.mapSize.toArray(),e.mapType=this.mapType,e.camera=this.camera.toJSON(!1).object,delete e.camera.matrix,e}},Xg=new X,Zg=new ld,Qg=new X,$g=class extends sf{constructor(){super(),this.isCamera=!0,this.type=`Camera`,this.matrixWorldInverse=new Nd,this.projectionMatrix=new Nd,this.projectionMatrixInverse=new Nd,this.coordinateSystem=wu,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Xg,Zg,Qg),Qg.x===1&&Qg.y===1&&Qg.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Xg,Zg,Qg.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(Xg,Zg,Qg),Qg.x===1&&Qg.y===1&&Qg.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Xg,Zg,Qg.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},e_=new X,t_=new Y,n_=new Y,r_=class extends $g{constructor(e=50,t=1,n=.1,r=2e3){super(),this.isPerspectiveCamera=!0,this.type=`PerspectiveCamera`,this.fov=e,this.zoom=1,this.near=n,this.far=r,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=zu*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(Ru*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return zu*2*Math.atan(Math.tan(Ru*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){e_.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(e_.x,e_.y).multiplyScalar(-e/e_.z),e_.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(e_.x,e_.y).multiplyScalar(-e/e_.z)}getViewSize(e,t){return this.getViewBounds(e,t_,n_),t.subVectors(n_,t_)}setViewOffset(e,t,n,r,i,a){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(Ru*.5*this.fov)/this.zoom,n=2*t,r=this.aspect*n,i=-.5*r,a=this.view;if(this.view!==null&&this.view.enabled){let e=a.fullWidth,o=a.fullHeight;i+=a.offsetX*r/e,t-=a.offsetY*n/o,r*=a.width/e,n*=a.height/o}let o=this.filmOffset;o!==0&&(i+=e*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(i,i+r,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}},i_=class extends $g{constructor(e=-1,t=1,n=1,r=-1,i=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type=`OrthographicCamera`,this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=r,this.near=i,this.far=a,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,r,i,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,r=(this.top+this.bottom)/2,i=n-e,a=n+e,o=r+t,s=r-t;if(this.view!==null&&this.view.enabled){let e=(this.right-this.left)/this.view.fullWidth/this.zoom,t=(this.top-this.bottom)/this.view.fullHeight/this.zoom;i+=e*this.view.offsetX,a=i+e*this.view.width,o-=t*this.view.offsetY,s=o-t*this.view.height}this.projectionMatrix.makeOrthographic(i,a,o,s,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},a_=class extends Yg{constructor(){super(new i_(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},o_=class extends Wg{constructor(e,t){super(e,t),this.isDirectionalLight=!0,this.type=`DirectionalLight`,this.position.copy(sf.DEFAULT_UP),this.updateMatrix(),this.target=new sf,this.shadow=new a_}dispose(){super.dispose(),this.shadow.dispose()}copy(e){return super.copy(e),this.target=e.target.clone(),this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.shadow=this.shadow.toJSON(),t.object.target=this.target.uuid,t}},s_=class extends lp{constructor(){super(),this.isInstancedBufferGeometry=!0,this.type=`InstancedBufferGeometry`,this.instanceCount=1/0}copy(e){return super.copy(e),this.instanceCount=e.instanceCount,this}toJSON(){let e=super.toJSON();return e.instanceCount=this.instanceCount,e.isInstancedBufferGeometry=!0,e}},c_=-90,l_=1,u_=class extends sf{constructor(e,t,n){super(),this.type=`CubeCamera`,this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let r=new r_(c_,l_,e,t);r.layers=this.layers,this.add(r);let i=new r_(c_,l_,e,t);i.layers=this.layers,this.add(i);let a=new r_(c_,l_,e,t);a.layers=this.layers,this.add(a);let o=new r_(c_,l_,e,t);o.layers=this.layers,this.add(o);let s=new r_(c_,l_,e,t);s.layers=this.layers,this.add(s);let c=new r_(c_,l_,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,r,i,a,o,s]=t;for(let e of t)this.remove(e);if(e===2e3)n.up.set(0,1,0),n.lookAt(1,0,0),r.up.set(0,1,0),r.lookAt(-1,0,0),i.up.set(0,0,-1),i.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),s.up.set(0,1,0),s.lookAt(0,0,-1);else if(e===2001)n.up.set(0,-1,0),n.lookAt(-1,0,0),r.up.set(0,-1,0),r.lookAt(1,0,0),i.up.set(0,0,1),i.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),s.up.set(0,-1,0),s.lookAt(0,0,-1);else throw Error(`THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: `+e);for(let e of t)this.add(e),e.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:r}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[i,a,o,s,c,l]=this.children,u=e.getRenderTarget(),d=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),p=e.xr.enabled;e.xr.enabled=!1;let m=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let h=!1;h=e.isWebGLRenderer===!0?e.state.buffers.depth.getReversed():e.reversedDepthBuffer,e.setRenderTarget(n,0,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,i),e.setRenderTarget(n,1,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,2,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,3,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,s),e.setRenderTarget(n,4,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=m,e.setRenderTarget(n,5,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(u,d,f),e.xr.enabled=p,n.texture.needsPMREMUpdate=!0}},d_=class extends r_{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}},f_=`\\[\\]\\.:\\/`,p_=RegExp(`[\\[\\]\\.:\\/]`,`g`),m_=`[^\\[\\]\\.:\\/]`,h_=`[^`+f_.replace(`\\.`,``)+`]`,g_=`((?:WC+[\\/:])*)`.replace(`WC`,m_),__=`(WCOD+)?`.replace(`WCOD`,h_),v_=`(?:\\.(WC+)(?:\\[(.+)\\])?)?`.replace(`WC`,m_),y_=`\\.(WC+)(?:\\[(.+)\\])?`.replace(`WC`,m_),b_=RegExp(`^`+g_+__+v_+y_+`$`),x_=[`material`,`materials`,`bones`,`map`],S_=class{constructor(e,t,n){let r=n||C_.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,r)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,r=this._bindings[n];r!==void 0&&r.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let r=this._targetGroup.nCachedObjects_,i=n.length;r!==i;++r)n[r].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},C_=class e{constructor(t,n,r){this.path=n,this.parsedPath=r||e.parseTrackName(n),this.node=e.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,n,r){return t&&t.isAnimationObjectGroup?new e.Composite(t,n,r):new e(t,n,r)}static sanitizeNodeName(e){return e.replace(/\s/g,`_`).replace(p_,``)}static parseTrackName(e){let t=b_.exec(e);if(t===null)throw Error(`THREE.PropertyBinding: Cannot parse trackName: `+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},r=n.nodeName&&n.nodeName.lastIndexOf(`.`);if(r!==void 0&&r!==-1){let e=n.nodeName.substring(r+1);x_.indexOf(e)!==-1&&(n.nodeName=n.nodeName.substring(0,r),n.objectName=e)}if(n.propertyName===null||n.propertyName.length===0)throw Error(`THREE.PropertyBinding: can not parse propertyName from trackName: `+e);return n}static findNode(e,t){if(t===void 0||t===``||t===`.`||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(e){for(let r=0;r<e.length;r++){let i=e[r];if(i.name===t||i.uuid===t)return i;let a=n(i.children);if(a)return a}return null},r=n(e.children);if(r)return r}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)e[t++]=n[r]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let t=this.node,n=this.parsedPath,r=n.objectName,i=n.propertyName,a=n.propertyIndex;if(t||(t=e.findNode(this.rootNode,n.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){K(`PropertyBinding: No target node found for track: `+this.path+`.`);return}if(r){let e=n.objectIndex;switch(r){case`materials`:if(!t.material){q(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.materials){q(`PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.`,this);return}t=t.material.materials;break;case`bones`:if(!t.skeleton){q(`PropertyBinding: Can not bind to bones as node does not have a skeleton.`,this);return}t=t.skeleton.bones;for(let n=0;n<t.length;n++)if(t[n].name===e){e=n;break}break;case`map`:if(`map`in t){t=t.map;break}if(!t.material){q(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.map){q(`PropertyBinding: Can not bind to material.map as node.material does not have a map.`,this);return}t=t.material.map;break;default:if(t[r]===void 0){q(`PropertyBinding: Can not bind to objectName of node undefined.`,this);return}t=t[r]}if(e!==void 0){if(t[e]===void 0){q(`PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.`,this,t);return}t=t[e]}}let o=t[i];if(o===void 0){let e=n.nodeName;q(`PropertyBinding: Trying to update property for track: `+e+`.`+i+` but it wasn't found.`,t);return}let s=this.Versioning.None;this.targetObject=t,t.isMaterial===!0?s=this.Versioning.NeedsUpdate:t.isObject3D===!0&&(s=this.Versioning.MatrixWorldNeedsUpdate);let c=this.BindingType.Direct;if(a!==void 0){if(i===`morphTargetInfluences`){if(!t.geometry){q(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.`,this);return}if(!t.geometry.morphAttributes){q(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.`,this);return}t.morphTargetDictionary[a]!==void 0&&(a=t.morphTargetDictionary[a])}c=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=a}else o.fromArray!==void 0&&o.toArray!==void 0?(c=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(c=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=i;this.getValue=this.GetterByBindingType[c],this.setValue=this.SetterByBindingTypeAndVersioning[c][s]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};C_.Composite=S_,C_.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3},C_.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2},C_.prototype.GetterByBindingType=[C_.prototype._getValue_direct,C_.prototype._getValue_array,C_.prototype._getValue_arrayElement,C_.prototype._getValue_toArray],C_.prototype.SetterByBindingTypeAndVersioning=[[C_.prototype._setValue_direct,C_.prototype._setValue_direct_setNeedsUpdate,C_.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[C_.prototype._setValue_array,C_.prototype._setValue_array_setNeedsUpdate,C_.prototype._setValue_array_setMatrixWorldNeedsUpdate],[C_.prototype._setValue_arrayElement,C_.prototype._setValue_arrayElement_setNeedsUpdate,C_.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[C_.prototype._setValue_fromArray,C_.prototype._setValue_fromArray_setNeedsUpdate,C_.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var w_=class extends up{constructor(e,t,n=1){super(e,t),this.isInstancedInterleavedBuffer=!0,this.meshPerAttribute=n}copy(e){return super.copy(e),this.meshPerAttribute=e.meshPerAttribute,this}clone(e){let t=super.clone(e);return t.meshPerAttribute=this.meshPerAttribute,t}toJSON(e){let t=super.toJSON(e);return t.isInstancedInterleavedBuffer=!0,t.meshPerAttribute=this.meshPerAttribute,t}},T_=new Nd,E_=class{constructor(e,t,n=0,r=1/0){this.ray=new wp(e,t),this.near=n,this.far=r,this.camera=null,this.layers=new Wd,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(e,t){this.ray.set(e,t)}setFromCamera(e,t){t.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(e.x,e.y,.5).unproject(t).sub(this.ray.origin).normalize(),this.camera=t):t.isOrthographicCamera?(this.ray.origin.set(e.x,e.y,t.projectionMatrix.elements[14]).unproject(t),this.ray.direction.set(0,0,-1).transformDirection(t.matrixWorld),this.camera=t):q(`Raycaster: Unsupported camera type: `+t.type)}setFromXRController(e){return T_.identity().extractRotation(e.matrixWorld),this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(T_),this}intersectObject(e,t=!0,n=[]){return O_(e,this,n,t),n.sort(D_),n}intersectObjects(e,t=!0,n=[]){for(let r=0,i=e.length;r<i;r++)O_(e[r],this,n,t);return n.sort(D_),n}};function D_(e,t){return e.distance-t.distance}function O_(e,t,n,r){let i=!0;if(e.layers.test(t.layers)&&e.raycast(t,n)===!1&&(i=!1),i===!0&&r===!0){let r=e.children;for(let e=0,i=r.length;e<i;e++)O_(r[e],t,n,!0)}}var k_=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){let e=1e-6;return this.phi=J(this.phi,e,Math.PI-e),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(J(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};(class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,r){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,r)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,r){let i=this.elements;return i[0]=e,i[2]=t,i[1]=n,i[3]=r,this}});var A_=new X,j_=new X,M_=new X,N_=new X,P_=new X,F_=new X,I_=new X,L_=class{constructor(e=new X,t=new X){this.start=e,this.end=t}set(e,t){return this.start.copy(e),this.end.copy(t),this}copy(e){return this.start.copy(e.start),this.end.copy(e.end),this}getCenter(e){return e.addVectors(this.start,this.end).multiplyScalar(.5)}delta(e){return e.subVectors(this.end,this.start)}distanceSq(){return this.start.distanceToSquared(this.end)}distance(){return this.start.distanceTo(this.end)}at(e,t){return this.delta(t).multiplyScalar(e).add(this.start)}closestPointToPointParameter(e,t){A_.subVectors(e,this.start),j_.subVectors(this.end,this.start);let n=j_.dot(j_);if(n===0)return 0;let r=j_.dot(A_)/n;return t&&(r=J(r,0,1)),r}closestPointToPoint(e,t,n){let r=this.closestPointToPointParameter(e,t);return this.delta(n).multiplyScalar(r).add(this.start)}distanceSqToLine3(e,t=F_,n=I_){let r=1e-8*1e-8,i,a,o=this.start,s=e.start,c=this.end,l=e.end;M_.subVectors(c,o),N_.subVectors(l,s),P_.subVectors(o,s);let u=M_.dot(M_),d=N_.dot(N_),f=N_.dot(P_);if(u<=r&&d<=r)return t.copy(o),n.copy(s),t.distanceToSquared(n);if(u<=r)i=0,a=f/d,a=J(a,0,1);else{let e=M_.dot(P_);if(d<=r)a=0,i=J(-e/u,0,1);else{let t=M_.dot(N_),n=u*d-t*t;i=n===0?0:J((t*f-e*d)/n,0,1),a=(t*i+f)/d,a<0?(a=0,i=J(-e/u,0,1)):a>1&&(a=1,i=J((t-e)/u,0,1))}}return t.copy(o).addScaledVector(M_,i),n.copy(s).addScaledVector(N_,a),t.distanceToSquared(n)}applyMatrix4(e){return this.start.applyMatrix4(e),this.end.applyMatrix4(e),this}equals(e){return e.start.equals(this.start)&&e.end.equals(this.end)}clone(){return new this.constructor().copy(this)}},R_=class extends Fu{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function z_(e,t,n,r){let i=B_(r);switch(n){case _l:return e*t;case Sl:return e*t/i.components*i.byteLength;case Cl:return e*t/i.components*i.byteLength;case wl:return e*t*2/i.components*i.byteLength;case Tl:return e*t*2/i.components*i.byteLength;case vl:return e*t*3/i.components*i.byteLength;case yl:return e*t*4/i.components*i.byteLength;case El:return e*t*4/i.components*i.byteLength;case Dl:case Ol:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case kl:case Al:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Ml:case Pl:return Math.max(e,16)*Math.max(t,8)/4;case jl:case Nl:return Math.max(e,8)*Math.max(t,8)/2;case Fl:case Il:case Rl:case zl:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case Ll:case Bl:case Vl:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Hl:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Ul:return Math.floor((e+4)/5)*Math.floor((t+3)/4)*16;case Wl:return Math.floor((e+4)/5)*Math.floor((t+4)/5)*16;case Gl:return Math.floor((e+5)/6)*Math.floor((t+4)/5)*16;case Kl:return Math.floor((e+5)/6)*Math.floor((t+5)/6)*16;case ql:return Math.floor((e+7)/8)*Math.floor((t+4)/5)*16;case Jl:return Math.floor((e+7)/8)*Math.floor((t+5)/6)*16;case Yl:return Math.floor((e+7)/8)*Math.floor((t+7)/8)*16;case Xl:return Math.floor((e+9)/10)*Math.floor((t+4)/5)*16;case Zl:return Math.floor((e+9)/10)*Math.floor((t+5)/6)*16;case Ql:return Math.floor((e+9)/10)*Math.floor((t+7)/8)*16;case $l:return Math.floor((e+9)/10)*Math.floor((t+9)/10)*16;case eu:return Math.floor((e+11)/12)*Math.floor((t+9)/10)*16;case tu:return Math.floor((e+11)/12)*Math.floor((t+11)/12)*16;case nu:case ru:case iu:return Math.ceil(e/4)*Math.ceil(t/4)*16;case au:case ou:return Math.ceil(e/4)*Math.ceil(t/4)*8;case su:case cu:return Math.ceil(e/4)*Math.ceil(t/4)*16}throw Error(`Unable to determine texture byte length for ${n} format.`)}function B_(e){switch(e){case il:case al:return{byteLength:1,components:1};case sl:case ol:case dl:return{byteLength:2,components:1};case fl:case pl:return{byteLength:2,components:4};case ll:case cl:case ul:return{byteLength:4,components:1};case hl:case gl:return{byteLength:4,components:3}}throw Error(`THREE.TextureUtils: Unknown texture type ${e}.`)}typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`register`,{detail:{revision:`187`}})),typeof window<`u`&&(window.__THREE__?K(`WARNING: Multiple instances of Three.js being imported.`):window.__THREE__=`187`);function V_(){let e=null,t=!1,n=null,r=null;function i(t,a){r=e.requestAnimationFrame(i),n(t,a)}return{start:function(){t!==!0&&n!==null&&e!==null&&(r=e.requestAnimationFrame(i),t=!0)},stop:function(){e!==null&&e.cancelAnimationFrame(r),t=!1},setAnimationLoop:function(e){n=e},setContext:function(t){e=t}}}function H_(e){let t=new WeakMap;function n(t,n){let r=t.array,i=t.usage,a=r.byteLength,o=e.createBuffer();e.bindBuffer(n,o),e.bufferData(n,r,i),t.onUploadCallback();let s;if(r instanceof Float32Array)s=e.FLOAT;else if(typeof Float16Array<`u`&&r instanceof Float16Array)s=e.HALF_FLOAT;else if(r instanceof Uint16Array)s=t.isFloat16BufferAttribute?e.HALF_FLOAT:e.UNSIGNED_SHORT;else if(r instanceof Int16Array)s=e.SHORT;else if(r instanceof Uint32Array)s=e.UNSIGNED_INT;else if(r instanceof Int32Array)s=e.INT;else if(r instanceof Int8Array)s=e.BYTE;else if(r instanceof Uint8Array)s=e.UNSIGNED_BYTE;else if(r instanceof Uint8ClampedArray)s=e.UNSIGNED_BYTE;else throw Error(`THREE.WebGLAttributes: Unsupported buffer data format: `+r);return{buffer:o,type:s,bytesPerElement:r.BYTES_PER_ELEMENT,version:t.version,size:a}}function r(t,n,r){let i=n.array,a=n.updateRanges;if(e.bindBuffer(r,t),a.length===0)e.bufferSubData(r,0,i);else{a.sort((e,t)=>e.start-t.start);let t=0;for(let e=1;e<a.length;e++){let n=a[t],r=a[e];r.start<=n.start+n.count+1?n.count=Math.max(n.count,r.start+r.count-n.start):(++t,a[t]=r)}a.length=t+1;for(let t=0,n=a.length;t<n;t++){let n=a[t];e.bufferSubData(r,n.start*i.BYTES_PER_ELEMENT,i,n.start,n.count)}n.clearUpdateRanges()}n.onUploadCallback()}function i(e){return e.isInterleavedBufferAttribute&&(e=e.data),t.get(e)}function a(n){n.isInterleavedBufferAttribute&&(n=n.data);let r=t.get(n);r&&(e.deleteBuffer(r.buffer),t.delete(n))}function o(e,i){if(e.isInterleavedBufferAttribute&&(e=e.data),e.isGLBufferAttribute){let n=t.get(e);(!n||n.version<e.version)&&t.set(e,{buffer:e.buffer,type:e.type,bytesPerElement:e.elementSize,version:e.version});return}let a=t.get(e);if(a===void 0)t.set(e,n(e,i));else if(a.version<e.version){if(a.size!==e.array.byteLength)throw Error(`THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.`);r(a.buffer,e,i),a.version=e.version}}return{get:i,remove:a,update:o}}var U_={alphahash_fragment:`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,alphahash_pars_fragment:`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,alphamap_fragment:`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,alphamap_pars_fragment:`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,alphatest_fragment:`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,alphatest_pars_fragment:`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,aomap_fragment:`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,aomap_pars_fragment:`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,batching_pars_vertex:`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,batching_vertex:`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,begin_vertex:`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,beginnormal_vertex:`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,bsdfs:`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,iridescence_fragment:`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,bumpmap_pars_fragment:`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,clipping_planes_fragment:`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,clipping_planes_pars_fragment:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,clipping_planes_pars_vertex:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,clipping_planes_vertex:`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,color_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,color_pars_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,color_pars_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,color_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,common:`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,defaultnormal_vertex:`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,displacementmap_pars_vertex:`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,displacementmap_vertex:`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,emissivemap_fragment:`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,emissivemap_pars_fragment:`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,colorspace_fragment:`gl_FragColor = linearToOutputTexel( gl_FragColor );`,colorspace_pars_fragment:`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,envmap_fragment:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,envmap_common_pars_fragment:`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,envmap_pars_fragment:`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,envmap_pars_vertex:`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,envmap_physical_pars_fragment:`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,envmap_vertex:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,fog_vertex:`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,fog_pars_vertex:`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,fog_fragment:`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,fog_pars_fragment:`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,gradientmap_pars_fragment:`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,lightmap_pars_fragment:`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,lights_lambert_fragment:`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,lights_lambert_pars_fragment:`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,lights_pars_begin:`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,lights_toon_fragment:`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,lights_toon_pars_fragment:`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,lights_phong_fragment:`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,lights_phong_pars_fragment:`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,lights_physical_fragment:`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,lights_physical_pars_fragment:`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,lights_fragment_begin:`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,lights_fragment_maps:`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,lights_fragment_end:`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,lightprobes_pars_fragment:`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,logdepthbuf_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,logdepthbuf_pars_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_pars_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,map_fragment:`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,map_pars_fragment:`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,map_particle_fragment:`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,map_particle_pars_fragment:`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,metalnessmap_fragment:`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,metalnessmap_pars_fragment:`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,morphinstance_vertex:`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,morphcolor_vertex:`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,morphnormal_vertex:`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,morphtarget_pars_vertex:`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,morphtarget_vertex:`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,normal_fragment_begin:`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,normal_fragment_maps:`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,normal_pars_fragment:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_pars_vertex:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_vertex:`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,normalmap_pars_fragment:`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,clearcoat_normal_fragment_begin:`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,clearcoat_normal_fragment_maps:`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,clearcoat_pars_fragment:`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,iridescence_pars_fragment:`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,opaque_fragment:`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,packing:`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,premultiplied_alpha_fragment:`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,project_vertex:`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,dithering_fragment:`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,dithering_pars_fragment:`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,roughnessmap_fragment:`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,roughnessmap_pars_fragment:`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,shadowmap_pars_fragment:`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,shadowmap_pars_vertex:`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,shadowmap_vertex:`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,shadowmask_pars_fragment:`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,skinbase_vertex:`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,skinning_pars_vertex:`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,skinning_vertex:`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,skinnormal_vertex:`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,specularmap_fragment:`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,specularmap_pars_fragment:`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,tonemapping_fragment:`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,tonemapping_pars_fragment:`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,transmission_fragment:`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,transmission_pars_fragment:`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,uv_pars_fragment:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_pars_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,worldpos_vertex:`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,background_vert:`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,background_frag:`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,backgroundCube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,backgroundCube_frag:`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,cube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,cube_frag:`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,depth_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,depth_frag:`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,distance_vert:`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,distance_frag:`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,equirect_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,equirect_frag:`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,linedashed_vert:`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,linedashed_frag:`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,meshbasic_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,meshbasic_frag:`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshlambert_vert:`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshlambert_frag:`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshmatcap_vert:`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,meshmatcap_frag:`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshnormal_vert:`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,meshnormal_frag:`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,meshphong_vert:`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshphong_frag:`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshphysical_vert:`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,meshphysical_frag:`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshtoon_vert:`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshtoon_frag:`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,points_vert:`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,points_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,shadow_vert:`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,shadow_frag:`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,sprite_vert:`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,sprite_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`},$={common:{diffuse:{value:new Z(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new fd},alphaMap:{value:null},alphaMapTransform:{value:new fd},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new fd}},envmap:{envMap:{value:null},envMapRotation:{value:new fd},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new fd}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new fd}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new fd},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new fd},normalScale:{value:new Y(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new fd},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new fd}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new fd}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new fd}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new Z(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new Z(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new fd},alphaTest:{value:0},uvTransform:{value:new fd}},sprite:{diffuse:{value:new Z(16777215)},opacity:{value:1},center:{value:new Y(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new fd},alphaMap:{value:null},alphaMapTransform:{value:new fd},alphaTest:{value:0}}},W_={basic:{uniforms:ag([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.fog]),vertexShader:U_.meshbasic_vert,fragmentShader:U_.meshbasic_frag},lambert:{uniforms:ag([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.fog,$.lights,{emissive:{value:new Z(0)},envMapIntensity:{value:1}}]),vertexShader:U_.meshlambert_vert,fragmentShader:U_.meshlambert_frag},phong:{uniforms:ag([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.fog,$.lights,{emissive:{value:new Z(0)},specular:{value:new Z(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:U_.meshphong_vert,fragmentShader:U_.meshphong_frag},standard:{uniforms:ag([$.common,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.roughnessmap,$.metalnessmap,$.fog,$.lights,{emissive:{value:new Z(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:U_.meshphysical_vert,fragmentShader:U_.meshphysical_frag},toon:{uniforms:ag([$.common,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.gradientmap,$.fog,$.lights,{emissive:{value:new Z(0)}}]),vertexShader:U_.meshtoon_vert,fragmentShader:U_.meshtoon_frag},matcap:{uniforms:ag([$.common,$.bumpmap,$.normalmap,$.displacementmap,$.fog,{matcap:{value:null}}]),vertexShader:U_.meshmatcap_vert,fragmentShader:U_.meshmatcap_frag},points:{uniforms:ag([$.points,$.fog]),vertexShader:U_.points_vert,fragmentShader:U_.points_frag},dashed:{uniforms:ag([$.common,$.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:U_.linedashed_vert,fragmentShader:U_.linedashed_frag},depth:{uniforms:ag([$.common,$.displacementmap]),vertexShader:U_.depth_vert,fragmentShader:U_.depth_frag},normal:{uniforms:ag([$.common,$.bumpmap,$.normalmap,$.displacementmap,{opacity:{value:1}}]),vertexShader:U_.meshnormal_vert,fragmentShader:U_.meshnormal_frag},sprite:{uniforms:ag([$.sprite,$.fog]),vertexShader:U_.sprite_vert,fragmentShader:U_.sprite_frag},background:{uniforms:{uvTransform:{value:new fd},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:U_.background_vert,fragmentShader:U_.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new fd}},vertexShader:U_.backgroundCube_vert,fragmentShader:U_.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:U_.cube_vert,fragmentShader:U_.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:U_.equirect_vert,fragmentShader:U_.equirect_frag},distance:{uniforms:ag([$.common,$.displacementmap,{referencePosition:{value:new X},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:U_.distance_vert,fragmentShader:U_.distance_frag},shadow:{uniforms:ag([$.lights,$.fog,{color:{value:new Z(0)},opacity:{value:1}}]),vertexShader:U_.shadow_vert,fragmentShader:U_.shadow_frag}};W_.physical={uniforms:ag([W_.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new fd},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new fd},clearcoatNormalScale:{value:new Y(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new fd},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new fd},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new fd},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new fd},sheen:{value:0},sheenColor:{value:new Z(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new fd},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new fd},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new fd},transmissionSamplerSize:{value:new Y},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new fd},attenuationDistance:{value:0},attenuationColor:{value:new Z(0)},specularColor:{value:new Z(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new fd},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new fd},anisotropyVector:{value:new Y},anisotropyMap:{value:null},anisotropyMapTransform:{value:new fd}}]),vertexShader:U_.meshphysical_vert,fragmentShader:U_.meshphysical_frag};var G_={r:0,b:0,g:0},K_=new Nd,q_=new fd;q_.set(-1,0,0,0,1,0,0,0,1);function J_(e,t,n,r,i,a){let o=new Z(0),s=i===!0?0:1,c,l,u=null,d=0,f=null;function p(e){let n=e.isScene===!0?e.background:null;if(n&&n.isTexture){let r=e.backgroundBlurriness>0;n=t.get(n,r)}return n}function m(t){let r=!1,i=p(t);i===null?g(o,s):i&&i.isColor&&(g(i,1),r=!0);let c=e.xr.getEnvironmentBlendMode();c===`additive`?n.buffers.color.setClear(0,0,0,1,a):c===`alpha-blend`&&n.buffers.color.setClear(0,0,0,0,a),(e.autoClear||r)&&(n.buffers.depth.setTest(!0),n.buffers.depth.setMask(!0),n.buffers.color.setMask(!0),e.clear(e.autoClearColor,e.autoClearDepth,e.autoClearStencil))}function h(t,n){let i=p(n);i&&i.isCubeTexture?(l===void 0&&(l=new Lp(new xm(1,1,1),new fg({name:`BackgroundCubeMaterial`,uniforms:ig(W_.backgroundCube.uniforms),vertexShader:W_.backgroundCube.vertexShader,fragmentShader:W_.backgroundCube.fragmentShader,side:1,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute(`normal`),l.geometry.deleteAttribute(`uv`),l.onBeforeRender=function(e,t,n){this.matrixWorld.copyPosition(n.matrixWorld)},Object.defineProperty(l.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),r.update(l)),l.material.uniforms.envMap.value=i,l.material.uniforms.backgroundBlurriness.value=n.backgroundBlurriness,l.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,l.material.uniforms.backgroundRotation.value.setFromMatrix4(K_.makeRotationFromEuler(n.backgroundRotation)).transpose(),i.isRenderTargetTexture===!1&&l.material.uniforms.backgroundRotation.value.premultiply(q_),l.material.toneMapped=_d.getTransfer(i.colorSpace)!==xu,(u!==i||d!==i.version||f!==e.toneMapping)&&(l.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),l.layers.enableAll(),t.unshift(l,l.geometry,l.material,0,0,null)):i&&i.isTexture&&(c===void 0&&(c=new Lp(new Yh(2,2),new fg({name:`BackgroundMaterial`,uniforms:ig(W_.background.uniforms),vertexShader:W_.background.vertexShader,fragmentShader:W_.background.fragmentShader,side:0,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute(`normal`),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),r.update(c)),c.material.uniforms.t2D.value=i,c.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,c.material.toneMapped=_d.getTransfer(i.colorSpace)!==xu,i.matrixAutoUpdate===!0&&i.updateMatrix(),c.material.uniforms.uvTransform.value.copy(i.matrix),(u!==i||d!==i.version||f!==e.toneMapping)&&(c.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),c.layers.enableAll(),t.unshift(c,c.geometry,c.material,0,0,null))}function g(t,r){t.getRGB(G_,cg(e)),n.buffers.color.setClear(G_.r,G_.g,G_.b,r,a)}function _(){l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0),c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0)}return{getClearColor:function(){return o},setClearColor:function(e,t=1){o.set(e),s=t,g(o,s)},getClearAlpha:function(){return s},setClearAlpha:function(e){s=e,g(o,s)},render:m,addToRenderList:h,dispose:_}}function Y_(e,t){let n=e.getParameter(e.MAX_VERTEX_ATTRIBS),r={},i=f(null),a=i,o=!1;function s(n,r,i,s,c){let u=!1,f=d(n,s,i,r);a!==f&&(a=f,l(a.object)),u=p(n,s,i,c),u&&m(n,s,i,c),c!==null&&t.update(c,e.ELEMENT_ARRAY_BUFFER),(u||o)&&(o=!1,b(n,r,i,s),c!==null&&e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,t.get(c).buffer))}function c(){return e.createVertexArray()}function l(t){return e.bindVertexArray(t)}function u(t){return e.deleteVertexArray(t)}function d(e,t,n,i){let a=i.wireframe===!0,o=r[t.id];o===void 0&&(o={},r[t.id]=o);let s=e.isInstancedMesh===!0?e.id:0,l=o[s];l===void 0&&(l={},o[s]=l);let u=l[n.id];u===void 0&&(u={},l[n.id]=u);let d=u[a];return d===void 0&&(d=f(c()),u[a]=d),d}function f(e){let t=[],r=[],i=[];for(let e=0;e<n;e++)t[e]=0,r[e]=0,i[e]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:t,enabledAttributes:r,attributeDivisors:i,object:e,attributes:{},index:null}}function p(e,t,n,r){let i=a.attributes,o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=i[t],r=o[t];if(r===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(r=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(r=e.instanceColor)),n===void 0||n.attribute!==r||r&&n.data!==r.data)return!0;s++}return a.attributesNum!==s||a.index!==r}function m(e,t,n,r){let i={},o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=o[t];n===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(n=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(n=e.instanceColor));let r={};r.attribute=n,n&&n.data&&(r.data=n.data),i[t]=r,s++}a.attributes=i,a.attributesNum=s,a.index=r}function h(){let e=a.newAttributes;for(let t=0,n=e.length;t<n;t++)e[t]=0}function g(e){_(e,0)}function _(t,n){let r=a.newAttributes,i=a.enabledAttributes,o=a.attributeDivisors;r[t]=1,i[t]===0&&(e.enableVertexAttribArray(t),i[t]=1),o[t]!==n&&(e.vertexAttribDivisor(t,n),o[t]=n)}function v(){let t=a.newAttributes,n=a.enabledAttributes;for(let r=0,i=n.length;r<i;r++)n[r]!==t[r]&&(e.disableVertexAttribArray(r),n[r]=0)}function y(t,n,r,i,a,o,s){s===!0?e.vertexAttribIPointer(t,n,r,a,o):e.vertexAttribPointer(t,n,r,i,a,o)}function b(n,r,i,a){h();let o=a.attributes,s=i.getAttributes(),c=r.defaultAttributeValues;for(let r in s){let i=s[r];if(i.location>=0){let s=o[r];if(s===void 0&&(r===`instanceMatrix`&&n.instanceMatrix&&(s=n.instanceMatrix),r===`instanceColor`&&n.instanceColor&&(s=n.instanceColor)),s!==void 0){let r=s.normalized,o=s.itemSize,c=t.get(s);if(c===void 0)continue;let l=c.buffer,u=c.type,d=c.bytesPerElement,f=u===e.INT||u===e.UNSIGNED_INT||s.gpuType===1013;if(s.isInterleavedBufferAttribute){let t=s.data,c=t.isInterleavedBuffer===!0?t.stride:t.itemSize,p=s.offset;if(t.isInstancedInterleavedBuffer||t.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,t.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=t.meshPerAttribute*t.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,c*d,(p+o/i.locationSize*e)*d,f)}else{if(s.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,s.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=s.meshPerAttribute*s.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,o*d,o/i.locationSize*e*d,f)}}else if(c!==void 0){let t=c[r];if(t!==void 0)switch(t.length){case 2:e.vertexAttrib2fv(i.location,t);break;case 3:e.vertexAttrib3fv(i.location,t);break;case 4:e.vertexAttrib4fv(i.location,t);break;default:e.vertexAttrib1fv(i.location,t)}}}}v()}function x(){T();for(let e in r){let t=r[e];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e]}}function S(e){if(r[e.id]===void 0)return;let t=r[e.id];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e.id]}function C(e){for(let t in r){let n=r[t];for(let t in n){let r=n[t];if(r[e.id]===void 0)continue;let i=r[e.id];for(let e in i)u(i[e].object),delete i[e];delete r[e.id]}}}function w(e){for(let t in r){let n=r[t],i=e.isInstancedMesh===!0?e.id:0,a=n[i];if(a!==void 0){for(let e in a){let t=a[e];for(let e in t)u(t[e].object),delete t[e];delete a[e]}delete n[i],Object.keys(n).length===0&&delete r[t]}}}function T(){E(),o=!0,a!==i&&(a=i,l(a.object))}function E(){i.geometry=null,i.program=null,i.wireframe=!1}return{setup:s,reset:T,resetDefaultState:E,dispose:x,releaseStatesOfGeometry:S,releaseStatesOfObject:w,releaseStatesOfProgram:C,initAttributes:h,enableAttribute:g,disableUnusedAttributes:v}}function X_(e,t,n){let r;function i(e){r=e}function a(t,i){e.drawArrays(r,t,i),n.update(i,r,1)}function o(t,i,a){a!==0&&(e.drawArraysInstanced(r,t,i,a),n.update(i,r,a))}function s(e,i,a){if(a===0)return;t.get(`WEBGL_multi_draw`).multiDrawArraysWEBGL(r,e,0,i,0,a);let o=0;for(let e=0;e<a;e++)o+=i[e];n.update(o,r,1)}this.setMode=i,this.render=a,this.renderInstances=o,this.renderMultiDraw=s}function Z_(e,t,n,r){let i;function a(){if(i!==void 0)return i;if(t.has(`EXT_texture_filter_anisotropic`)===!0){let n=t.get(`EXT_texture_filter_anisotropic`);i=e.getParameter(n.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else i=0;return i}function o(t){return t===1023||r.convert(t)===e.getParameter(e.IMPLEMENTATION_COLOR_READ_FORMAT)}function s(n){let i=n===1016&&(t.has(`EXT_color_buffer_half_float`)||t.has(`EXT_color_buffer_float`));return!(n!==1009&&n!==1015&&!i&&r.convert(n)!==e.getParameter(e.IMPLEMENTATION_COLOR_READ_TYPE))}function c(t){if(t===`highp`){if(e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.HIGH_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.HIGH_FLOAT).precision>0)return`highp`;t=`mediump`}return t===`mediump`&&e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.MEDIUM_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.MEDIUM_FLOAT).precision>0?`mediump`:`lowp`}let l=n.precision===void 0?`highp`:n.precision,u=c(l);u!==l&&(K(`WebGLRenderer:`,l,`not supported, using`,u,`instead.`),l=u);let d=n.reversedDepthBuffer===!0&&t.has(`EXT_clip_control`),f=n.logarithmicDepthBuffer===!0&&d===!1;n.reversedDepthBuffer===!0&&d===!1&&K(`WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer.`),n.logarithmicDepthBuffer===!0&&d===!0&&K(`WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.`);let p=e.getParameter(e.MAX_TEXTURE_IMAGE_UNITS),m=e.getParameter(e.MAX_VERTEX_TEXTURE_IMAGE_UNITS),h=e.getParameter(e.MAX_TEXTURE_SIZE),g=e.getParameter(e.MAX_CUBE_MAP_TEXTURE_SIZE),_=e.getParameter(e.MAX_VERTEX_ATTRIBS),v=e.getParameter(e.MAX_VERTEX_UNIFORM_VECTORS),y=e.getParameter(e.MAX_VARYING_VECTORS),b=e.getParameter(e.MAX_FRAGMENT_UNIFORM_VECTORS),x=e.getParameter(e.MAX_SAMPLES),S=e.getParameter(e.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:a,getMaxPrecision:c,textureFormatReadable:o,textureTypeReadable:s,precision:l,logarithmicDepthBuffer:f,reversedDepthBuffer:d,maxTextures:p,maxVertexTextures:m,maxTextureSize:h,maxCubemapSize:g,maxAttributes:_,maxVertexUniforms:v,maxVaryings:y,maxFragmentUniforms:b,maxSamples:x,samples:S}}function Q_(e){let t=this,n=null,r=0,i=!1,a=!1,o=new _p,s=new fd,c={value:null,needsUpdate:!1};this.uniform=c,this.numPlanes=0,this.numIntersection=0,this.init=function(e,t){let n=e.length!==0||t||r!==0||i;return i=t,r=e.length,n},this.beginShadows=function(){a=!0,u(null)},this.endShadows=function(){a=!1},this.setGlobalState=function(e,t){n=u(e,t,0)},this.setState=function(t,o,s){let d=t.clippingPlanes,f=t.clipIntersection,p=t.clipShadows,m=e.get(t);if(!i||d===null||d.length===0||a&&!p)a?u(null):l();else{let e=a?0:r,t=e*4,i=m.clippingState||null;c.value=i,i=u(d,o,t,s);for(let e=0;e!==t;++e)i[e]=n[e];m.clippingState=i,this.numIntersection=f?this.numPlanes:0,this.numPlanes+=e}};function l(){c.value!==n&&(c.value=n,c.needsUpdate=r>0),t.numPlanes=r,t.numIntersection=0}function u(e,n,r,i){let a=e===null?0:e.length,l=null;if(a!==0){if(l=c.value,i!==!0||l===null){let t=r+a*4,i=n.matrixWorldInverse;s.getNormalMatrix(i),(l===null||l.length<t)&&(l=new Float32Array(t));for(let t=0,n=r;t!==a;++t,n+=4)o.copy(e[t]).applyMatrix4(i,s),o.normal.toArray(l,n),l[n+3]=o.constant}c.value=l,c.needsUpdate=!0}return t.numPlanes=a,t.numIntersection=0,l}}var $_=class extends Ad{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},r=[n,n,n,n,n,n];this.texture=new gm(r),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},r=new xm(5,5,5),i=new fg({name:`CubemapFromEquirect`,uniforms:ig(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:1,blending:0});i.uniforms.tEquirect.value=t;let a=new Lp(r,i),o=t.minFilter;return t.minFilter===1008&&(t.minFilter=tl),new u_(1,10,this).update(e,a),t.minFilter=o,a.geometry.dispose(),a.material.dispose(),this}clear(e,t=!0,n=!0,r=!0){let i=e.getRenderTarget();for(let i=0;i<6;i++)e.setRenderTarget(this,i),e.clear(t,n,r);e.setRenderTarget(i)}},ev=256,tv=3,nv=20,rv=256,iv=16,av=3,ov=new X,sv=new Z,cv=class e{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new u_(1,10,null),this._boxMesh=new Lp(new xm(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,r=100,i={}){let{size:a=256,position:o=ov}=i,s=this._renderer;this._setSize(a);let c=this._allocateTarget(),l=this._getSourceTarget(!0);t>0&&(l.texture.mipmapsAutoUpdate=!1);let u=s.autoClear,d=s.autoClearColor,f=s.autoClearDepth,p=s.autoClearStencil,m=e.background;s.autoClear=!0,s.autoClearColor=!0,s.autoClearDepth=!0,s.autoClearStencil=!0,m===null&&(e.background=s.getClearColor(sv));let h=new u_(n,r,l);return h.position.copy(o),h.update(s,e),s.autoClear=u,s.autoClearColor=d,s.autoClearDepth=f,s.autoClearStencil=p,e.background=m,t>0&&(l.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=hv(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=mv(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(ev,rd(e))}_fromTexture(e,t){e.mapping===301||e.mapping===302?this._setSize(e.image.length===0?ev:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=lv(e,!1,!1),n=Math.log2(e)-tv;for(let r=0;r<=n;r++)t.texture.mipmaps.push({width:e>>r,height:e>>r});return t.texture.name=`PMREM`,t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=lv(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let r=this._boxMesh,i=this._cubeCamera;r.material=n,i.renderTarget=e,i.activeMipmapLevel=t;let a=e.width>>t;e.viewport.set(0,0,a,a),i.update(this._renderer,r),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===301||e.mapping===302?(this._cubemapMaterial===null&&(this._cubemapMaterial=hv()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=mv()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=dv(),this._integrationMaterial=fv());let n=this._cubeSize,r=t.texture.mipmaps.length-1,i=this._ggxMaterial.uniforms;i.envMap.value=this._sourceTarget.texture;let a=this._integrationMaterial.uniforms;a.envMap.value=this._sourceTarget.texture,a.sourceLod.value=Math.log2(n/iv);for(let o=0;o<=r;o++){let s=e.lodToRoughness(o,r);if(o>r-av)a.roughness.value=s,this._renderCube(t,o,this._integrationMaterial);else{let e=s>0?Math.log2(n)+.5*Math.log2(6/(rv*s**4))+.5:0;i.roughness.value=s,i.lodBias.value=e,this._renderCube(t,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=pv());let n=this._blurMaterial,r=n.uniforms,i=this._sourceTarget;r.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,r.envMap.value=i.texture,this._renderCube(e,0,n),r.envMap.value=e.texture,this._renderCube(i,0,n)}};function lv(e,t,n){return new $_(e,{minFilter:rl,generateMipmaps:t,type:dl,colorSpace:yu,depthBuffer:n})}function uv(e,t,n){return new fg({name:e,uniforms:t,vertexShader:U_.cube_vert,fragmentShader:n,side:1,blending:0,depthTest:!1,depthWrite:!1})}function dv(){return uv(`PMREMGGXConvolution`,{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${rv}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function fv(){return uv(`PMREMGGXIntegration`,{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:iv}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function pv(){return uv(`PMREMSphericalGaussianBlur`,{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${nv}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function mv(){return uv(`PMREMEquirectangularToCubemap`,{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function hv(){return uv(`PMREMCubemapToCubemap`,{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function gv(e){let t=new WeakMap,n=new WeakMap,r=null;function i(e,t=!1){return e==null?null:t?o(e):a(e)}function a(n){if(n&&n.isTexture){let r=n.mapping;if(r===303||r===304){if(t.has(n)){let e=t.get(n).texture;return s(e,n.mapping)}{let r=n.image;if(r&&r.height>0){let i=new $_(r.height);return i.fromEquirectangularTexture(e,n),t.set(n,i),n.addEventListener(`dispose`,l),s(i.texture,n.mapping)}return null}}}return n}function o(t){if(t&&t.isTexture&&t.isPMREMTexture!==!0){let i=t.mapping,a=i===303||i===304,o=i===301||i===302;if(a||o){let i=n.get(t),s=i===void 0?0:i.texture.pmremVersion;if(t.isRenderTargetTexture&&t.pmremVersion!==s)return r===null&&(r=new cv(e)),i=a?r.fromEquirectangular(t,i):r.fromCubemap(t,i),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),i.texture;if(i!==void 0)return i.texture;{let s=t.image;return a&&s&&s.height>0||o&&s&&c(s)?(r===null&&(r=new cv(e)),i=a?r.fromEquirectangular(t):r.fromCubemap(t),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),t.addEventListener(`dispose`,u),i.texture):null}}}return t}function s(e,t){return t===303?e.mapping=301:t===304&&(e.mapping=302),e}function c(e){let t=0;for(let n=0;n<6;n++)e[n]!==void 0&&t++;return t===6}function l(e){let n=e.target;n.removeEventListener(`dispose`,l);let r=t.get(n);r!==void 0&&(t.delete(n),r.dispose())}function u(e){let t=e.target;t.removeEventListener(`dispose`,u);let r=n.get(t);r!==void 0&&(n.delete(t),r.dispose())}function d(){t=new WeakMap,n=new WeakMap,r!==null&&(r.dispose(),r=null)}return{get:i,dispose:d}}function _v(e){let t={};function n(n){if(t[n]!==void 0)return t[n];let r=e.getExtension(n);return t[n]=r,r}return{has:function(e){return n(e)!==null},init:function(){n(`EXT_color_buffer_float`),n(`WEBGL_clip_cull_distance`),n(`OES_texture_float_linear`),n(`EXT_color_buffer_half_float`),n(`WEBGL_multisampled_render_to_texture`),n(`WEBGL_render_shared_exponent`)},get:function(e){let t=n(e);return t===null&&Mu(`WebGLRenderer: `+e+` extension not supported.`),t}}}function vv(e,t,n,r){let i={},a=new WeakMap,o=new FinalizationRegistry(e=>delete i[e]);function s(e){c(e.target)}function c(e){e.index!==null&&t.remove(e.index);for(let n in e.attributes)t.remove(e.attributes[n]);e.removeEventListener(`dispose`,s),delete i[e.id],o.unregister(e);let c=a.get(e);c&&(t.remove(c),a.delete(e)),r.releaseStatesOfGeometry(e),e.isInstancedBufferGeometry===!0&&delete e._maxInstanceCount,n.memory.geometries--}function l(e,t){return i[t.id]===void 0&&(t.addEventListener(`dispose`,s),i[t.id]=new WeakRef(t),o.register(t,t.id,t),n.memory.geometries++),t}function u(n){let r=n.attributes;for(let n in r)t.update(r[n],e.ARRAY_BUFFER)}function d(e){let n=e.index,r=e.attributes.position,i=0;if(r===void 0)return;let o=n===null?r.array.length/3-1:n.array.length,s=new(r.count>=65535?Zf:Xf)(Math.ceil(o/3)*6,1),c=s.array;if(n!==null){let e=n.array;i=n.version;for(let t=0,n=0;t<o;t+=3){let r=e[t+0],i=e[t+1],a=e[t+2];c[n++]=r,c[n++]=i,c[n++]=i,c[n++]=a,c[n++]=a,c[n++]=r}}else{i=r.version;for(let e=0,t=0;e<o;e+=3){let n=e+0,r=e+1,i=e+2;c[t++]=n,c[t++]=r,c[t++]=r,c[t++]=i,c[t++]=i,c[t++]=n}}s.version=i;let l=a.get(e);l&&t.remove(l),a.set(e,s)}function f(e){let t=a.get(e);if(t){let n=e.index;n!==null&&t.version<n.version&&d(e)}else d(e);return a.get(e)}function p(){for(let e in i){let t=i[e].deref();t!==void 0&&c(t)}}return{get:l,update:u,getWireframeAttribute:f,dispose:p}}function yv(e,t,n){let r;function i(e){r=e}let a,o;function s(e){a=e.type,o=e.bytesPerElement}function c(t,i){e.drawElements(r,i,a,t*o),n.update(i,r,1)}function l(t,i,s){s!==0&&(e.drawElementsInstanced(r,i,a,t*o,s),n.update(i,r,s))}function u(e,i,o){if(o===0)return;t.get(`WEBGL_multi_draw`).multiDrawElementsWEBGL(r,i,0,a,e,0,o);let s=0;for(let e=0;e<o;e++)s+=i[e];n.update(s,r,1)}this.setMode=i,this.setIndex=s,this.render=c,this.renderInstances=l,this.renderMultiDraw=u}function bv(e){let t={geometries:0,textures:0},n={frame:0,calls:0,triangles:0,points:0,lines:0};function r(t,r,i){switch(n.calls++,r){case e.TRIANGLES:n.triangles+=t/3*i;break;case e.LINES:n.lines+=t/2*i;break;case e.LINE_STRIP:n.lines+=i*(t-1);break;case e.LINE_LOOP:n.lines+=i*t;break;case e.POINTS:n.points+=i*t;break;default:q(`WebGLInfo: Unknown draw mode:`,r)}}function i(){n.calls=0,n.triangles=0,n.points=0,n.lines=0}return{memory:t,render:n,programs:null,autoReset:!0,reset:i,update:r}}function xv(e,t,n){let r=new WeakMap,i=new Od;function a(a,o,s){let c=a.morphTargetInfluences,l=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,u=l===void 0?0:l.length,d=r.get(o);if(d===void 0||d.count!==u){d!==void 0&&d.texture.dispose();let e=o.morphAttributes.position!==void 0,n=o.morphAttributes.normal!==void 0,a=o.morphAttributes.color!==void 0,s=o.morphAttributes.position||[],c=o.morphAttributes.normal||[],l=o.morphAttributes.color||[],f=0;e===!0&&(f=1),n===!0&&(f=2),a===!0&&(f=3);let p=o.attributes.position.count*f,m=1;p>t.maxTextureSize&&(m=Math.ceil(p/t.maxTextureSize),p=t.maxTextureSize);let h=new Float32Array(p*m*4*u),g=new jd(h,p,m,u);g.type=ul,g.needsUpdate=!0;let _=f*4;for(let t=0;t<u;t++){let r=s[t],o=c[t],u=l[t],d=p*m*4*t;for(let t=0;t<r.count;t++){let s=t*_;e===!0&&(i.fromBufferAttribute(r,t),h[d+s+0]=i.x,h[d+s+1]=i.y,h[d+s+2]=i.z,h[d+s+3]=0),n===!0&&(i.fromBufferAttribute(o,t),h[d+s+4]=i.x,h[d+s+5]=i.y,h[d+s+6]=i.z,h[d+s+7]=0),a===!0&&(i.fromBufferAttribute(u,t),h[d+s+8]=i.x,h[d+s+9]=i.y,h[d+s+10]=i.z,h[d+s+11]=u.itemSize===4?i.w:1)}}d={count:u,texture:g,size:new Y(p,m)},r.set(o,d);function v(){g.dispose(),r.delete(o),o.removeEventListener(`dispose`,v)}o.addEventListener(`dispose`,v)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)s.getUniforms().setValue(e,`morphTexture`,a.morphTexture,n);else{let t=0;for(let e=0;e<c.length;e++)t+=c[e];let n=o.morphTargetsRelative?1:1-t;s.getUniforms().setValue(e,`morphTargetBaseInfluence`,n),s.getUniforms().setValue(e,`morphTargetInfluences`,c)}s.getUniforms().setValue(e,`morphTargetsTexture`,d.texture,n),s.getUniforms().setValue(e,`morphTargetsTextureSize`,d.size)}return{update:a}}function Sv(e,t,n,r,i){let a=new WeakMap;function o(r){let o=i.render.frame,s=r.geometry,l=t.get(r,s);if(a.get(l)!==o&&(t.update(l),a.set(l,o)),r.isInstancedMesh&&(r.hasEventListener(`dispose`,c)===!1&&r.addEventListener(`dispose`,c),a.get(r)!==o&&(n.update(r.instanceMatrix,e.ARRAY_BUFFER),r.instanceColor!==null&&n.update(r.instanceColor,e.ARRAY_BUFFER),a.set(r,o))),r.isSkinnedMesh){let e=r.skeleton;a.get(e)!==o&&(e.update(),a.set(e,o))}return l}function s(){a=new WeakMap}function c(e){let t=e.target;t.removeEventListener(`dispose`,c),r.releaseStatesOfObject(t),n.remove(t.instanceMatrix),t.instanceColor!==null&&n.remove(t.instanceColor)}return{update:o,dispose:s}}var Cv={1:`LINEAR_TONE_MAPPING`,2:`REINHARD_TONE_MAPPING`,3:`CINEON_TONE_MAPPING`,4:`ACES_FILMIC_TONE_MAPPING`,6:`AGX_TONE_MAPPING`,7:`NEUTRAL_TONE_MAPPING`,5:`CUSTOM_TONE_MAPPING`};function wv(e,t,n,r,i,a){let o=new Ad(t,n,{type:e,depthBuffer:i,stencilBuffer:a,samples:r?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),s=null,c=null,l=null,u=new lp;u.setAttribute(`position`,new Q([-1,3,0,-1,-1,0,3,-1,0],3)),u.setAttribute(`uv`,new Q([0,2,0,0,2,0],2));let d=new pg({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new Lp(u,d),p=new i_(-1,1,1,-1,0,1),m=null,h=null,g=!1,_,v=null,y=[],b=!1;this.setSize=function(e,t){o.setSize(e,t),s!==null&&s.setSize(e,t),c!==null&&c.setSize(e,t);for(let n=0;n<y.length;n++){let r=y[n];r.setSize&&r.setSize(e,t)}},this.setEffects=function(e){y=e,b=y.length>0&&y[0].isRenderPass===!0;let t=o.width,n=o.height;y.length>0&&s===null&&(s=new Ad(t,n,{type:dl,depthBuffer:!1,stencilBuffer:!1}),c=new Ad(t,n,{type:dl,depthBuffer:!1,stencilBuffer:!1}));let r=i===!0&&y.some(e=>e.needsDepthTexture===!0);r!==(o.depthTexture!==null)&&(r===!0&&l===null&&(l=new vm(t,n),a===!0&&(l.format=xl,l.type=ml)),o.dispose(),o.depthTexture=r?l:null,o.resolveDepthBuffer=r,o.storeMultisampledDepthBuffer=r);for(let e=0;e<y.length;e++){let i=y[e];i.setSize&&i.setSize(t,n),r&&i.needsDepthTexture===!0&&i.setDepthTexture&&i.setDepthTexture(l)}},this.begin=function(e,t){if(g||e.toneMapping===0&&y.length===0)return!1;if(v=t,t!==null){let e=t.width,n=t.height;(o.width!==e||o.height!==n)&&this.setSize(e,n)}return b===!1&&e.setRenderTarget(o),_=e.toneMapping,e.toneMapping=0,!0},this.hasRenderPass=function(){return b},this.end=function(e,t){e.toneMapping=_,g=!0;let n=o,r=s;for(let i=0;i<y.length;i++){let a=y[i];a.enabled!==!1&&(a.render(e,r,n,t),a.needsSwap!==!1&&(n=r,r=r===s?c:s))}if(m!==e.outputColorSpace||h!==e.toneMapping){m=e.outputColorSpace,h=e.toneMapping,d.defines={},_d.getTransfer(m)===`srgb`&&(d.defines.SRGB_TRANSFER=``);let t=Cv[h];t&&(d.defines[t]=``),d.needsUpdate=!0}d.uniforms.tDiffuse.value=n.texture,e.setRenderTarget(v),e.render(f,p),v=null,g=!1},this.isCompositing=function(){return g},this.dispose=function(){o.dispose(),s!==null&&s.dispose(),c!==null&&c.dispose(),u.dispose(),d.dispose()}}var Tv=new Dd,Ev=new vm(1,1),Dv=new ym(1),Ov=new jd,kv=new Md,Av=new gm,jv=[],Mv=[],Nv=new Float32Array(16),Pv=new Float32Array(9),Fv=new Float32Array(4);function Iv(e,t,n){let r=e[0];if(r<=0||r>0)return e;let i=t*n,a=jv[i];if(a===void 0&&(a=new Float32Array(i),jv[i]=a),t!==0){r.toArray(a,0);for(let r=1,i=0;r!==t;++r)i+=n,e[r].toArray(a,i)}return a}function Lv(e,t){if(e.length!==t.length)return!1;for(let n=0,r=e.length;n<r;n++)if(e[n]!==t[n])return!1;return!0}function Rv(e,t){for(let n=0,r=t.length;n<r;n++)e[n]=t[n]}function zv(e,t){let n=Mv[t];n===void 0&&(n=new Int32Array(t),Mv[t]=n);for(let r=0;r!==t;++r)n[r]=e.allocateTextureUnit();return n}function Bv(e,t){let n=this.cache;n[0]!==t&&(e.uniform1f(this.addr,t),n[0]=t)}function Vv(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2f(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(Lv(n,t))return;e.uniform2fv(this.addr,t),Rv(n,t)}}function Hv(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3f(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else if(t.r!==void 0)(n[0]!==t.r||n[1]!==t.g||n[2]!==t.b)&&(e.uniform3f(this.addr,t.r,t.g,t.b),n[0]=t.r,n[1]=t.g,n[2]=t.b);else{if(Lv(n,t))return;e.uniform3fv(this.addr,t),Rv(n,t)}}function Uv(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4f(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(Lv(n,t))return;e.uniform4fv(this.addr,t),Rv(n,t)}}function Wv(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(Lv(n,t))return;e.uniformMatrix2fv(this.addr,!1,t),Rv(n,t)}else{if(Lv(n,r))return;Fv.set(r),e.uniformMatrix2fv(this.addr,!1,Fv),Rv(n,r)}}function Gv(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(Lv(n,t))return;e.uniformMatrix3fv(this.addr,!1,t),Rv(n,t)}else{if(Lv(n,r))return;Pv.set(r),e.uniformMatrix3fv(this.addr,!1,Pv),Rv(n,r)}}function Kv(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(Lv(n,t))return;e.uniformMatrix4fv(this.addr,!1,t),Rv(n,t)}else{if(Lv(n,r))return;Nv.set(r),e.uniformMatrix4fv(this.addr,!1,Nv),Rv(n,r)}}function qv(e,t){let n=this.cache;n[0]!==t&&(e.uniform1i(this.addr,t),n[0]=t)}function Jv(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2i(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(Lv(n,t))return;e.uniform2iv(this.addr,t),Rv(n,t)}}function Yv(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3i(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(Lv(n,t))return;e.uniform3iv(this.addr,t),Rv(n,t)}}function Xv(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4i(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(Lv(n,t))return;e.uniform4iv(this.addr,t),Rv(n,t)}}function Zv(e,t){let n=this.cache;n[0]!==t&&(e.uniform1ui(this.addr,t),n[0]=t)}function Qv(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2ui(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(Lv(n,t))return;e.uniform2uiv(this.addr,t),Rv(n,t)}}function $v(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3ui(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(Lv(n,t))return;e.uniform3uiv(this.addr,t),Rv(n,t)}}function ey(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4ui(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(Lv(n,t))return;e.uniform4uiv(this.addr,t),Rv(n,t)}}function ty(e){return e.version===0&&(e.compareFunction=519,e.needsUpdate=!0),e}function ny(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_2D_SHADOW?ty(Ev):Tv,n.setTexture2D(t||a,i)}function ry(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture3D(t||kv,i)}function iy(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_CUBE_SHADOW?ty(Dv):Av,n.setTextureCube(t||a,i)}function ay(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture2DArray(t||Ov,i)}function oy(e){switch(e){case 5126:return Bv;case 35664:return Vv;case 35665:return Hv;case 35666:return Uv;case 35674:return Wv;case 35675:return Gv;case 35676:return Kv;case 5124:case 35670:return qv;case 35667:case 35671:return Jv;case 35668:case 35672:return Yv;case 35669:case 35673:return Xv;case 5125:return Zv;case 36294:return Qv;case 36295:return $v;case 36296:return ey;case 35678:case 36198:case 36298:case 36306:case 35682:return ny;case 35679:case 36299:case 36307:return ry;case 35680:case 36300:case 36308:case 36293:return iy;case 36289:case 36303:case 36311:case 36292:return ay}}function sy(e,t){e.uniform1fv(this.addr,t)}function cy(e,t){let n=Iv(t,this.size,2);e.uniform2fv(this.addr,n)}function ly(e,t){let n=Iv(t,this.size,3);e.uniform3fv(this.addr,n)}function uy(e,t){let n=Iv(t,this.size,4);e.uniform4fv(this.addr,n)}function dy(e,t){let n=Iv(t,this.size,4);e.uniformMatrix2fv(this.addr,!1,n)}function fy(e,t){let n=Iv(t,this.size,9);e.uniformMatrix3fv(this.addr,!1,n)}function py(e,t){let n=Iv(t,this.size,16);e.uniformMatrix4fv(this.addr,!1,n)}function my(e,t){e.uniform1iv(this.addr,t)}function hy(e,t){e.uniform2iv(this.addr,t)}function gy(e,t){e.uniform3iv(this.addr,t)}function _y(e,t){e.uniform4iv(this.addr,t)}function vy(e,t){e.uniform1uiv(this.addr,t)}function yy(e,t){e.uniform2uiv(this.addr,t)}function by(e,t){e.uniform3uiv(this.addr,t)}function xy(e,t){e.uniform4uiv(this.addr,t)}function Sy(e,t,n){let r=this.cache,i=t.length,a=zv(n,i);Lv(r,a)||(e.uniform1iv(this.addr,a),Rv(r,a));let o;o=this.type===e.SAMPLER_2D_SHADOW?ty(Ev):Tv;for(let e=0;e!==i;++e)n.setTexture2D(t[e]||o,a[e])}function Cy(e,t,n){let r=this.cache,i=t.length,a=zv(n,i);Lv(r,a)||(e.uniform1iv(this.addr,a),Rv(r,a));for(let e=0;e!==i;++e)n.setTexture3D(t[e]||kv,a[e])}function wy(e,t,n){let r=this.cache,i=t.length,a=zv(n,i);Lv(r,a)||(e.uniform1iv(this.addr,a),Rv(r,a));let o;o=this.type===e.SAMPLER_CUBE_SHADOW?ty(Dv):Av;for(let e=0;e!==i;++e)n.setTextureCube(t[e]||o,a[e])}function Ty(e,t,n){let r=this.cache,i=t.length,a=zv(n,i);Lv(r,a)||(e.uniform1iv(this.addr,a),Rv(r,a));for(let e=0;e!==i;++e)n.setTexture2DArray(t[e]||Ov,a[e])}function Ey(e){switch(e){case 5126:return sy;case 35664:return cy;case 35665:return ly;case 35666:return uy;case 35674:return dy;case 35675:return fy;case 35676:return py;case 5124:case 35670:return my;case 35667:case 35671:return hy;case 35668:case 35672:return gy;case 35669:case 35673:return _y;case 5125:return vy;case 36294:return yy;case 36295:return by;case 36296:return xy;case 35678:case 36198:case 36298:case 36306:case 35682:return Sy;case 35679:case 36299:case 36307:return Cy;case 35680:case 36300:case 36308:case 36293:return wy;case 36289:case 36303:case 36311:case 36292:return Ty}}var Dy=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=oy(t.type)}},Oy=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Ey(t.type)}},ky=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let r=this.seq;for(let i=0,a=r.length;i!==a;++i){let a=r[i];a.setValue(e,t[a.id],n)}}},Ay=/(\w+)(\])?(\[|\.)?/g;function jy(e,t){e.seq.push(t),e.map[t.id]=t}function My(e,t,n){let r=e.name,i=r.length;for(Ay.lastIndex=0;;){let a=Ay.exec(r),o=Ay.lastIndex,s=a[1],c=a[2]===`]`,l=a[3];if(c&&(s|=0),l===void 0||l===`[`&&o+2===i){jy(n,l===void 0?new Dy(s,e,t):new Oy(s,e,t));break}{let e=n.map[s];e===void 0&&(e=new ky(s),jy(n,e)),n=e}}}var Ny=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let r=0;r<n;++r){let n=e.getActiveUniform(t,r);My(n,e.getUniformLocation(t,n.name),this)}let r=[],i=[];for(let t of this.seq)t.type===e.SAMPLER_2D_SHADOW||t.type===e.SAMPLER_CUBE_SHADOW||t.type===e.SAMPLER_2D_ARRAY_SHADOW?r.push(t):i.push(t);r.length>0&&(this.seq=r.concat(i))}setValue(e,t,n,r){let i=this.map[t];i!==void 0&&i.setValue(e,n,r)}setOptional(e,t,n){let r=t[n];r!==void 0&&this.setValue(e,n,r)}static upload(e,t,n,r){for(let i=0,a=t.length;i!==a;++i){let a=t[i],o=n[a.id];o.needsUpdate!==!1&&a.setValue(e,o.value,r)}}static seqWithValue(e,t){let n=[];for(let r=0,i=e.length;r!==i;++r){let i=e[r];i.id in t&&n.push(i)}return n}};function Py(e,t,n){let r=e.createShader(t);return e.shaderSource(r,n),e.compileShader(r),r}var Fy=37297,Iy=0;function Ly(e,t){let n=e.split(`
`),r=[],i=Math.max(t-6,0),a=Math.min(t+6,n.length);for(let e=i;e<a;e++){let i=e+1;r.push(`${i===t?`>`:` `} ${i}: ${n[e]}`)}return r.join(`
`)}var Ry=new fd;function zy(e){_d._getMatrix(Ry,_d.workingColorSpace,e);let t=`mat3( ${Ry.elements.map(e=>e.toFixed(4))} )`;switch(_d.getTransfer(e)){case bu:return[t,`LinearTransferOETF`];case xu:return[t,`sRGBTransferOETF`];default:return K(`WebGLProgram: Unsupported color space: `,e),[t,`LinearTransferOETF`]}}function By(e,t,n){let r=e.getShaderParameter(t,e.COMPILE_STATUS),i=(e.getShaderInfoLog(t)||``).trim();if(r&&i===``)return``;let a=/ERROR: 0:(\d+)/.exec(i);if(a){let r=parseInt(a[1]);return n.toUpperCase()+`

`+i+`

`+Ly(e.getShaderSource(t),r)}return i}function Vy(e,t){let n=zy(t);return[`vec4 ${e}( vec4 value ) {`,`	return ${n[1]}( vec4( ${n[0]} * value.rgb, value.a ) );`,`}`].join(`
`)}var Hy={1:`Linear`,2:`Reinhard`,3:`Cineon`,4:`ACESFilmic`,6:`AgX`,7:`Neutral`,5:`Custom`};function Uy(e,t){let n=Hy[t];return n===void 0?(K(`WebGLProgram: Unsupported toneMapping:`,t),`vec3 `+e+`( vec3 color ) { return LinearToneMapping( color ); }`):`vec3 `+e+`( vec3 color ) { return `+n+`ToneMapping( color ); }`}var Wy=new X;function Gy(){return _d.getLuminanceCoefficients(Wy),[`float luminance( const in vec3 rgb ) {`,`	const vec3 weights = vec3( ${Wy.x.toFixed(4)}, ${Wy.y.toFixed(4)}, ${Wy.z.toFixed(4)} );`,`	return dot( weights, rgb );`,`}`].join(`
`)}function Ky(e){return[e.extensionClipCullDistance?`#extension GL_ANGLE_clip_cull_distance : require`:``,e.extensionMultiDraw?`#extension GL_ANGLE_multi_draw : require`:``].filter(Yy).join(`
`)}function qy(e){let t=[];for(let n in e){let r=e[n];r!==!1&&t.push(`#define `+n+` `+r)}return t.join(`
`)}function Jy(e,t){let n={},r=e.getProgramParameter(t,e.ACTIVE_ATTRIBUTES);for(let i=0;i<r;i++){let r=e.getActiveAttrib(t,i),a=r.name,o=1;r.type===e.FLOAT_MAT2&&(o=2),r.type===e.FLOAT_MAT3&&(o=3),r.type===e.FLOAT_MAT4&&(o=4),n[a]={type:r.type,location:e.getAttribLocation(t,a),locationSize:o}}return n}function Yy(e){return e!==``}function Xy(e,t){let n=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return e.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,n).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function Zy(e,t){return e.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var Qy=/^[ \t]*#include +<([\w\d./]+)>/gm;function $y(e){return e.replace(Qy,eb)}function eb(e,t){let n=U_[t];if(n===void 0)throw Error(`THREE.WebGLProgram: Can not resolve #include <`+t+`>`);return $y(n)}var tb=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function nb(e){return e.replace(tb,rb)}function rb(e,t,n,r){let i=``;for(let e=parseInt(t);e<parseInt(n);e++)i+=r.replace(/\[\s*i\s*\]/g,`[ `+e+` ]`).replace(/UNROLLED_LOOP_INDEX/g,e);return i}function ib(e){let t=`precision ${e.precision} float;
	precision ${e.precision} int;
	precision ${e.precision} sampler2D;
	precision ${e.precision} samplerCube;
	precision ${e.precision} sampler3D;
	precision ${e.precision} sampler2DArray;
	precision ${e.precision} sampler2DShadow;
	precision ${e.precision} samplerCubeShadow;
	precision ${e.precision} sampler2DArrayShadow;
	precision ${e.precision} isampler2D;
	precision ${e.precision} isampler3D;
	precision ${e.precision} isamplerCube;
	precision ${e.precision} isampler2DArray;
	precision ${e.precision} usampler2D;
	precision ${e.precision} usampler3D;
	precision ${e.precision} usamplerCube;
	precision ${e.precision} usampler2DArray;
	`;return e.precision===`highp`?t+=`
#define HIGH_PRECISION`:e.precision===`mediump`?t+=`
#define MEDIUM_PRECISION`:e.precision===`lowp`&&(t+=`
#define LOW_PRECISION`),t}var ab={1:`SHADOWMAP_TYPE_PCF`,3:`SHADOWMAP_TYPE_VSM`};function ob(e){return ab[e.shadowMapType]||`SHADOWMAP_TYPE_BASIC`}var sb={302:`ENVMAP_MODE_REFRACTION`};function cb(e){return e.envMap===!1?`ENVMAP_MODE_REFLECTION`:sb[e.envMapMode]||`ENVMAP_MODE_REFLECTION`}var lb={0:`ENVMAP_BLENDING_MULTIPLY`,1:`ENVMAP_BLENDING_MIX`,2:`ENVMAP_BLENDING_ADD`};function ub(e){return e.envMap===!1?`ENVMAP_BLENDING_NONE`:lb[e.combine]||`ENVMAP_BLENDING_NONE`}function db(e,t,n,r){let i=e.getContext(),a=n.defines,o=n.vertexShader,s=n.fragmentShader,c=ob(n),l=n.envMapPMREM===!0?`ENVMAP_TYPE_PMREM`:`ENVMAP_TYPE_CUBE`,u=cb(n),d=ub(n),f=Ky(n),p=qy(a),m=i.createProgram(),h,g,_=n.glslVersion?`#version `+n.glslVersion+`
`:``;n.isRawShaderMaterial?(h=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(Yy).join(`
`),h.length>0&&(h+=`
`),g=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(Yy).join(`
`),g.length>0&&(g+=`
`)):(h=[ib(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.extensionClipCullDistance?`#define USE_CLIP_DISTANCE`:``,n.batching?`#define USE_BATCHING`:``,n.batchingColor?`#define USE_BATCHING_COLOR`:``,n.instancing?`#define USE_INSTANCING`:``,n.instancingColor?`#define USE_INSTANCING_COLOR`:``,n.instancingMorph?`#define USE_INSTANCING_MORPH`:``,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.map?`#define USE_MAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+u:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.displacementMap?`#define USE_DISPLACEMENTMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.mapUv?`#define MAP_UV `+n.mapUv:``,n.alphaMapUv?`#define ALPHAMAP_UV `+n.alphaMapUv:``,n.lightMapUv?`#define LIGHTMAP_UV `+n.lightMapUv:``,n.aoMapUv?`#define AOMAP_UV `+n.aoMapUv:``,n.emissiveMapUv?`#define EMISSIVEMAP_UV `+n.emissiveMapUv:``,n.bumpMapUv?`#define BUMPMAP_UV `+n.bumpMapUv:``,n.normalMapUv?`#define NORMALMAP_UV `+n.normalMapUv:``,n.displacementMapUv?`#define DISPLACEMENTMAP_UV `+n.displacementMapUv:``,n.metalnessMapUv?`#define METALNESSMAP_UV `+n.metalnessMapUv:``,n.roughnessMapUv?`#define ROUGHNESSMAP_UV `+n.roughnessMapUv:``,n.anisotropyMapUv?`#define ANISOTROPYMAP_UV `+n.anisotropyMapUv:``,n.clearcoatMapUv?`#define CLEARCOATMAP_UV `+n.clearcoatMapUv:``,n.clearcoatNormalMapUv?`#define CLEARCOAT_NORMALMAP_UV `+n.clearcoatNormalMapUv:``,n.clearcoatRoughnessMapUv?`#define CLEARCOAT_ROUGHNESSMAP_UV `+n.clearcoatRoughnessMapUv:``,n.diffuseRoughnessMapUv?`#define DIFFUSE_ROUGHNESSMAP_UV `+n.diffuseRoughnessMapUv:``,n.iridescenceMapUv?`#define IRIDESCENCEMAP_UV `+n.iridescenceMapUv:``,n.iridescenceThicknessMapUv?`#define IRIDESCENCE_THICKNESSMAP_UV `+n.iridescenceThicknessMapUv:``,n.sheenColorMapUv?`#define SHEEN_COLORMAP_UV `+n.sheenColorMapUv:``,n.sheenRoughnessMapUv?`#define SHEEN_ROUGHNESSMAP_UV `+n.sheenRoughnessMapUv:``,n.specularMapUv?`#define SPECULARMAP_UV `+n.specularMapUv:``,n.specularColorMapUv?`#define SPECULAR_COLORMAP_UV `+n.specularColorMapUv:``,n.specularIntensityMapUv?`#define SPECULAR_INTENSITYMAP_UV `+n.specularIntensityMapUv:``,n.transmissionMapUv?`#define TRANSMISSIONMAP_UV `+n.transmissionMapUv:``,n.thicknessMapUv?`#define THICKNESSMAP_UV `+n.thicknessMapUv:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexNormals?`#define HAS_NORMAL`:``,n.vertexColors?`#define USE_COLOR`:``,n.vertexAlphas?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.flatShading?`#define FLAT_SHADED`:``,n.skinning?`#define USE_SKINNING`:``,n.morphTargets?`#define USE_MORPHTARGETS`:``,n.morphNormals&&n.flatShading===!1?`#define USE_MORPHNORMALS`:``,n.morphColors?`#define USE_MORPHCOLORS`:``,n.morphTargetsCount>0?`#define MORPHTARGETS_TEXTURE_STRIDE `+n.morphTextureStride:``,n.morphTargetsCount>0?`#define MORPHTARGETS_COUNT `+n.morphTargetsCount:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.sizeAttenuation?`#define USE_SIZEATTENUATION`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 modelMatrix;`,`uniform mat4 modelViewMatrix;`,`uniform mat4 projectionMatrix;`,`uniform mat4 viewMatrix;`,`uniform mat3 normalMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,`#ifdef USE_INSTANCING`,`	attribute mat4 instanceMatrix;`,`#endif`,`#ifdef USE_INSTANCING_COLOR`,`	attribute vec3 instanceColor;`,`#endif`,`#ifdef USE_INSTANCING_MORPH`,`	uniform sampler2D morphTexture;`,`#endif`,`attribute vec3 position;`,`attribute vec3 normal;`,`attribute vec2 uv;`,`#ifdef USE_UV1`,`	attribute vec2 uv1;`,`#endif`,`#ifdef USE_UV2`,`	attribute vec2 uv2;`,`#endif`,`#ifdef USE_UV3`,`	attribute vec2 uv3;`,`#endif`,`#ifdef USE_TANGENT`,`	attribute vec4 tangent;`,`#endif`,`#if defined( USE_COLOR_ALPHA )`,`	attribute vec4 color;`,`#elif defined( USE_COLOR )`,`	attribute vec3 color;`,`#endif`,`#ifdef USE_SKINNING`,`	attribute vec4 skinIndex;`,`	attribute vec4 skinWeight;`,`#endif`,`
`].filter(Yy).join(`
`),g=[ib(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.alphaToCoverage?`#define ALPHA_TO_COVERAGE`:``,n.map?`#define USE_MAP`:``,n.matcap?`#define USE_MATCAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+l:``,n.envMap?`#define `+u:``,n.envMap?`#define `+d:``,n.envMapPMREM?`#define ENVMAP_MAX_LOD `+n.envMapMaxLod+`.0`:``,n.envMapPMREM?`#define ENVMAP_SIZE `+n.envMapSize+`.0`:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.packedNormalMap?`#define USE_PACKED_NORMALMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoat?`#define USE_CLEARCOAT`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughness?`#define USE_DIFFUSE_ROUGHNESS`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.dispersion?`#define USE_DISPERSION`:``,n.retroreflection?`#define USE_RETROREFLECTION`:``,n.iridescence?`#define USE_IRIDESCENCE`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaTest?`#define USE_ALPHATEST`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.sheen?`#define USE_SHEEN`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexColors||n.instancingColor?`#define USE_COLOR`:``,n.vertexAlphas||n.batchingColor?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.gradientMap?`#define USE_GRADIENTMAP`:``,n.flatShading?`#define FLAT_SHADED`:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.premultipliedAlpha?`#define PREMULTIPLIED_ALPHA`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.decodeVideoTexture?`#define DECODE_VIDEO_TEXTURE`:``,n.decodeVideoTextureEmissive?`#define DECODE_VIDEO_TEXTURE_EMISSIVE`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 viewMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,n.toneMapping===0?``:`#define TONE_MAPPING`,n.toneMapping===0?``:U_.tonemapping_pars_fragment,n.toneMapping===0?``:Uy(`toneMapping`,n.toneMapping),n.dithering?`#define DITHERING`:``,n.opaque?`#define OPAQUE`:``,U_.colorspace_pars_fragment,Vy(`linearToOutputTexel`,n.outputColorSpace),Gy(),n.useDepthPacking?`#define DEPTH_PACKING `+n.depthPacking:``,`
`].filter(Yy).join(`
`)),o=$y(o),o=Xy(o,n),o=Zy(o,n),s=$y(s),s=Xy(s,n),s=Zy(s,n),o=nb(o),s=nb(s),n.isRawShaderMaterial!==!0&&(_=`#version 300 es
`,h=[f,`#define attribute in`,`#define varying out`,`#define texture2D texture`].join(`
`)+`
`+h,g=[`#define varying in`,n.glslVersion===`300 es`?``:`layout(location = 0) out highp vec4 pc_fragColor;`,n.glslVersion===`300 es`?``:`#define gl_FragColor pc_fragColor`,`#define gl_FragDepthEXT gl_FragDepth`,`#define texture2D texture`,`#define textureCube texture`,`#define texture2DProj textureProj`,`#define texture2DLodEXT textureLod`,`#define texture2DProjLodEXT textureProjLod`,`#define textureCubeLodEXT textureLod`,`#define texture2DGradEXT textureGrad`,`#define texture2DProjGradEXT textureProjGrad`,`#define textureCubeGradEXT textureGrad`].join(`
`)+`
`+g);let v=_+h+o,y=_+g+s,b=Py(i,i.VERTEX_SHADER,v),x=Py(i,i.FRAGMENT_SHADER,y);i.attachShader(m,b),i.attachShader(m,x),n.index0AttributeName===void 0?n.hasPositionAttribute===!0&&i.bindAttribLocation(m,0,`position`):i.bindAttribLocation(m,0,n.index0AttributeName),i.linkProgram(m);function S(t){if(e.debug.checkShaderErrors){let n=i.getProgramInfoLog(m)||``,r=i.getShaderInfoLog(b)||``,a=i.getShaderInfoLog(x)||``,o=n.trim(),s=r.trim(),c=a.trim(),l=!0,u=!0;if(i.getProgramParameter(m,i.LINK_STATUS)===!1){if(l=!1,typeof e.debug.onShaderError==`function`)e.debug.onShaderError(i,m,b,x);else{let e=By(i,b,`vertex`),n=By(i,x,`fragment`);q(`WebGLProgram: Shader Error `+i.getError()+` - VALIDATE_STATUS `+i.getProgramParameter(m,i.VALIDATE_STATUS)+`

Material Name: `+t.name+`
Material Type: `+t.type+`

Program Info Log: `+o+`
`+e+`
`+n)}}else o===``?(s===``||c===``)&&(u=!1):K(`WebGLProgram: Program Info Log:`,o);u&&(t.diagnostics={runnable:l,programLog:o,vertexShader:{log:s,prefix:h},fragmentShader:{log:c,prefix:g}})}i.deleteShader(b),i.deleteShader(x),C=new Ny(i,m),w=Jy(i,m)}let C;this.getUniforms=function(){return C===void 0&&S(this),C};let w;this.getAttributes=function(){return w===void 0&&S(this),w};let T=n.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return T===!1&&(T=i.getProgramParameter(m,Fy)),T},this.destroy=function(){r.releaseStatesOfProgram(this),i.deleteProgram(m),this.program=void 0},this.type=n.shaderType,this.name=n.shaderName,this.id=Iy++,this.cacheKey=t,this.usedTimes=1,this.program=m,this.vertexShader=b,this.fragmentShader=x,this}var fb=0,pb=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let r=this._getShaderCacheForMaterial(e);return r.has(t)===!1&&(r.add(t),t.usedTimes++),r.has(n)===!1&&(r.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let e of t)e.usedTimes--,e.usedTimes===0&&this.shaderCache.delete(e.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new mb(e),t.set(e,n)),n}},mb=class{constructor(e){this.id=fb++,this.code=e,this.usedTimes=0}};function hb(e){return e===1030||e===37490||e===36285}function gb(e,t,n,r,i,a){let o=new Wd,s=new pb,c=new Set,l=[],u=new Map,d=r.logarithmicDepthBuffer,f={MeshDepthMaterial:`depth`,MeshDistanceMaterial:`distance`,MeshNormalMaterial:`normal`,MeshBasicMaterial:`basic`,MeshLambertMaterial:`lambert`,MeshPhongMaterial:`phong`,MeshToonMaterial:`toon`,MeshStandardMaterial:`physical`,MeshPhysicalMaterial:`physical`,MeshMatcapMaterial:`matcap`,LineBasicMaterial:`basic`,LineDashedMaterial:`dashed`,PointsMaterial:`points`,ShadowMaterial:`shadow`,SpriteMaterial:`sprite`};function p(e){return c.add(e),e===0?`uv`:`uv${e}`}function m(i,o,l,u,m,h){let g=u.fog,_=m.geometry,v=i.isMeshStandardMaterial||i.isMeshLambertMaterial||i.isMeshPhongMaterial?u.environment:null,y=i.isMeshStandardMaterial||i.isMeshLambertMaterial&&!i.envMap||i.isMeshPhongMaterial&&!i.envMap,b=t.get(i.envMap||v,y),x=f[i.type],S=r.precision;i.precision!==null&&(S=r.getMaxPrecision(i.precision),S!==i.precision&&K(`WebGLProgram.getParameters:`,i.precision,`not supported, using`,S,`instead.`));let C=_.morphAttributes.position||_.morphAttributes.normal||_.morphAttributes.color,w=C===void 0?0:C.length,T=0;_.morphAttributes.position!==void 0&&(T=1),_.morphAttributes.normal!==void 0&&(T=2),_.morphAttributes.color!==void 0&&(T=3);let E,D,O,k;if(x){let e=W_[x];E=e.vertexShader,D=e.fragmentShader}else{E=i.vertexShader,D=i.fragmentShader;let e=s.getVertexShaderStage(i),t=s.getFragmentShaderStage(i);s.update(i,e,t),O=e.id,k=t.id}let A=e.getRenderTarget(),j=e.state.buffers.depth.getReversed(),M=m.isInstancedMesh===!0,N=m.isBatchedMesh===!0,ee=!!i.map,te=!!i.matcap,ne=!!b,re=ne&&b.isPMREMTexture===!0,P=!!i.aoMap,F=!!i.lightMap,ie=!!i.bumpMap&&i.wireframe===!1,I=!!i.normalMap,L=!!i.displacementMap,R=!!i.emissiveMap,z=!!i.metalnessMap,ae=!!i.roughnessMap,oe=i.anisotropy>0,se=i.clearcoat>0,ce=i.diffuseRoughness>0,le=i.dispersion>0,ue=i.retroreflectivity>0,de=i.iridescence>0,fe=i.sheen>0,pe=i.transmission>0,me=oe&&!!i.anisotropyMap,he=se&&!!i.clearcoatMap,ge=se&&!!i.clearcoatNormalMap,_e=se&&!!i.clearcoatRoughnessMap,ve=ce&&!!i.diffuseRoughnessMap,B=de&&!!i.iridescenceMap,V=de&&!!i.iridescenceThicknessMap,H=fe&&!!i.sheenColorMap,ye=fe&&!!i.sheenRoughnessMap,U=!!i.specularMap,be=!!i.specularColorMap,W=!!i.specularIntensityMap,G=pe&&!!i.transmissionMap,xe=pe&&!!i.thicknessMap,Se=!!i.gradientMap,Ce=!!i.alphaMap,we=i.alphaTest>0,Te=!!i.alphaHash,Ee=!!i.extensions,De=0;i.toneMapped&&(A===null||A.isXRRenderTarget===!0)&&(De=e.toneMapping);let Oe=re?b.isCompressedCubeTexture?b.image[0].mipmaps:b.mipmaps:null,ke={shaderID:x,shaderType:i.type,shaderName:i.name,vertexShader:E,fragmentShader:D,defines:i.defines,customVertexShaderID:O,customFragmentShaderID:k,isRawShaderMaterial:i.isRawShaderMaterial===!0,glslVersion:i.glslVersion,precision:S,batching:N,batchingColor:N&&m._colorsTexture!==null,instancing:M,instancingColor:M&&m.instanceColor!==null,instancingMorph:M&&m.morphTexture!==null,outputColorSpace:A===null?e.outputColorSpace:A.isXRRenderTarget===!0?A.texture.colorSpace:_d.workingColorSpace,alphaToCoverage:!!i.alphaToCoverage,map:ee,matcap:te,envMap:ne,envMapMode:ne&&b.mapping,envMapPMREM:re,envMapMaxLod:re?Oe.length-1:null,envMapSize:re?Oe[0].width:null,aoMap:P,lightMap:F,bumpMap:ie,normalMap:I,displacementMap:L,emissiveMap:R,normalMapObjectSpace:I&&i.normalMapType===1,normalMapTangentSpace:I&&i.normalMapType===0,packedNormalMap:I&&i.normalMapType===0&&hb(i.normalMap.format),metalnessMap:z,roughnessMap:ae,anisotropy:oe,anisotropyMap:me,clearcoat:se,clearcoatMap:he,clearcoatNormalMap:ge,clearcoatRoughnessMap:_e,diffuseRoughness:ce,diffuseRoughnessMap:ve,dispersion:le,retroreflection:ue,iridescence:de,iridescenceMap:B,iridescenceThicknessMap:V,sheen:fe,sheenColorMap:H,sheenRoughnessMap:ye,specularMap:U,specularColorMap:be,specularIntensityMap:W,transmission:pe,transmissionMap:G,thicknessMap:xe,gradientMap:Se,opaque:i.transparent===!1&&i.blending===1&&i.alphaToCoverage===!1,alphaMap:Ce,alphaTest:we,alphaHash:Te,combine:i.combine,mapUv:ee&&p(i.map.channel),aoMapUv:P&&p(i.aoMap.channel),lightMapUv:F&&p(i.lightMap.channel),bumpMapUv:ie&&p(i.bumpMap.channel),normalMapUv:I&&p(i.normalMap.channel),displacementMapUv:L&&p(i.displacementMap.channel),emissiveMapUv:R&&p(i.emissiveMap.channel),metalnessMapUv:z&&p(i.metalnessMap.channel),roughnessMapUv:ae&&p(i.roughnessMap.channel),anisotropyMapUv:me&&p(i.anisotropyMap.channel),clearcoatMapUv:he&&p(i.clearcoatMap.channel),clearcoatNormalMapUv:ge&&p(i.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:_e&&p(i.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:ve&&p(i.diffuseRoughnessMap.channel),iridescenceMapUv:B&&p(i.iridescenceMap.channel),iridescenceThicknessMapUv:V&&p(i.iridescenceThicknessMap.channel),sheenColorMapUv:H&&p(i.sheenColorMap.channel),sheenRoughnessMapUv:ye&&p(i.sheenRoughnessMap.channel),specularMapUv:U&&p(i.specularMap.channel),specularColorMapUv:be&&p(i.specularColorMap.channel),specularIntensityMapUv:W&&p(i.specularIntensityMap.channel),transmissionMapUv:G&&p(i.transmissionMap.channel),thicknessMapUv:xe&&p(i.thicknessMap.channel),alphaMapUv:Ce&&p(i.alphaMap.channel),vertexTangents:!!_.attributes.tangent&&(I||oe),vertexNormals:!!_.attributes.normal,vertexColors:i.vertexColors,vertexAlphas:i.vertexColors===!0&&!!_.attributes.color&&_.attributes.color.itemSize===4,pointsUvs:m.isPoints===!0&&!!_.attributes.uv&&(ee||Ce),fog:!!g,useFog:i.fog===!0,fogExp2:!!g&&g.isFogExp2,flatShading:i.wireframe===!1&&(i.flatShading===!0||_.attributes.normal===void 0&&I===!1&&(i.isMeshLambertMaterial||i.isMeshPhongMaterial||i.isMeshStandardMaterial||i.isMeshPhysicalMaterial)),sizeAttenuation:i.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:j,skinning:m.isSkinnedMesh===!0,hasPositionAttribute:_.attributes.position!==void 0,morphTargets:_.morphAttributes.position!==void 0,morphNormals:_.morphAttributes.normal!==void 0,morphColors:_.morphAttributes.color!==void 0,morphTargetsCount:w,morphTextureStride:T,numSunLights:o.sun.length,numDirLights:o.directional.length,numPointLights:o.point.length,numSpotLights:o.spot.length,numSpotLightMaps:o.spotLightMap.length,numRectAreaLights:o.rectArea.length,numHemiLights:o.hemi.length,numSunLightShadows:o.sunShadowMap.length,numDirLightShadows:o.directionalShadowMap.length,numPointLightShadows:o.pointShadowMap.length,numSpotLightShadows:o.spotShadowMap.length,numSpotLightShadowsWithMaps:o.numSpotLightShadowsWithMaps,numLightProbes:o.numLightProbes,numLightProbeGrids:h.filter(e=>e.texture!==null).length,numClippingPlanes:a.numPlanes,numClipIntersection:a.numIntersection,dithering:i.dithering,shadowMapEnabled:e.shadowMap.enabled&&l.length>0,shadowMapType:e.shadowMap.type,toneMapping:De,decodeVideoTexture:ee&&i.map.isVideoTexture===!0&&_d.getTransfer(i.map.colorSpace)===`srgb`,decodeVideoTextureEmissive:R&&i.emissiveMap.isVideoTexture===!0&&_d.getTransfer(i.emissiveMap.colorSpace)===`srgb`,premultipliedAlpha:i.premultipliedAlpha,doubleSided:i.side===2,flipSided:i.side===1,useDepthPacking:i.depthPacking>=0,depthPacking:i.depthPacking||0,index0AttributeName:i.index0AttributeName,extensionClipCullDistance:Ee&&i.extensions.clipCullDistance===!0&&n.has(`WEBGL_clip_cull_distance`),extensionMultiDraw:(Ee&&i.extensions.multiDraw===!0||N)&&n.has(`WEBGL_multi_draw`),rendererExtensionParallelShaderCompile:n.has(`KHR_parallel_shader_compile`),customProgramCacheKey:i.customProgramCacheKey()};return ke.vertexUv1s=c.has(1),ke.vertexUv2s=c.has(2),ke.vertexUv3s=c.has(3),c.clear(),ke}function h(t){let n=[];if(t.shaderID?n.push(t.shaderID):(n.push(t.customVertexShaderID),n.push(t.customFragmentShaderID)),t.defines!==void 0)for(let e in t.defines)n.push(e),n.push(t.defines[e]);return t.isRawShaderMaterial===!1&&(g(n,t),_(n,t),n.push(e.outputColorSpace)),n.push(t.customProgramCacheKey),n.join()}function g(e,t){e.push(t.precision),e.push(t.outputColorSpace),e.push(t.envMapMode),e.push(t.envMapPMREM),e.push(t.envMapMaxLod),e.push(t.envMapSize),e.push(t.mapUv),e.push(t.alphaMapUv),e.push(t.lightMapUv),e.push(t.aoMapUv),e.push(t.bumpMapUv),e.push(t.normalMapUv),e.push(t.displacementMapUv),e.push(t.emissiveMapUv),e.push(t.metalnessMapUv),e.push(t.roughnessMapUv),e.push(t.anisotropyMapUv),e.push(t.clearcoatMapUv),e.push(t.clearcoatNormalMapUv),e.push(t.clearcoatRoughnessMapUv),e.push(t.diffuseRoughnessMapUv),e.push(t.iridescenceMapUv),e.push(t.iridescenceThicknessMapUv),e.push(t.sheenColorMapUv),e.push(t.sheenRoughnessMapUv),e.push(t.specularMapUv),e.push(t.specularColorMapUv),e.push(t.specularIntensityMapUv),e.push(t.transmissionMapUv),e.push(t.thicknessMapUv),e.push(t.combine),e.push(t.fogExp2),e.push(t.sizeAttenuation),e.push(t.morphTargetsCount),e.push(t.numSunLights),e.push(t.numDirLights),e.push(t.numPointLights),e.push(t.numSpotLights),e.push(t.numSpotLightMaps),e.push(t.numHemiLights),e.push(t.numRectAreaLights),e.push(t.numSunLightShadows),e.push(t.numDirLightShadows),e.push(t.numPointLightShadows),e.push(t.numSpotLightShadows),e.push(t.numSpotLightShadowsWithMaps),e.push(t.numLightProbes),e.push(t.numLightProbeGrids),e.push(t.shadowMapType),e.push(t.toneMapping),e.push(t.numClippingPlanes),e.push(t.numClipIntersection),e.push(t.depthPacking)}function _(e,t){o.disableAll(),t.instancing&&o.enable(0),t.instancingColor&&o.enable(1),t.instancingMorph&&o.enable(2),t.matcap&&o.enable(3),t.envMap&&o.enable(4),t.normalMapObjectSpace&&o.enable(5),t.normalMapTangentSpace&&o.enable(6),t.clearcoat&&o.enable(7),t.iridescence&&o.enable(8),t.alphaTest&&o.enable(9),t.vertexColors&&o.enable(10),t.vertexAlphas&&o.enable(11),t.vertexUv1s&&o.enable(12),t.vertexUv2s&&o.enable(13),t.vertexUv3s&&o.enable(14),t.vertexTangents&&o.enable(15),t.anisotropy&&o.enable(16),t.alphaHash&&o.enable(17),t.batching&&o.enable(18),t.dispersion&&o.enable(19),t.retroreflection&&o.enable(24),t.diffuseRoughness&&o.enable(25),t.batchingColor&&o.enable(20),t.gradientMap&&o.enable(21),t.packedNormalMap&&o.enable(22),t.vertexNormals&&o.enable(23),e.push(o.mask),o.disableAll(),t.fog&&o.enable(0),t.useFog&&o.enable(1),t.flatShading&&o.enable(2),t.logarithmicDepthBuffer&&o.enable(3),t.reversedDepthBuffer&&o.enable(4),t.skinning&&o.enable(5),t.morphTargets&&o.enable(6),t.morphNormals&&o.enable(7),t.morphColors&&o.enable(8),t.premultipliedAlpha&&o.enable(9),t.shadowMapEnabled&&o.enable(10),t.doubleSided&&o.enable(11),t.flipSided&&o.enable(12),t.useDepthPacking&&o.enable(13),t.dithering&&o.enable(14),t.transmission&&o.enable(15),t.sheen&&o.enable(16),t.opaque&&o.enable(17),t.pointsUvs&&o.enable(18),t.decodeVideoTexture&&o.enable(19),t.decodeVideoTextureEmissive&&o.enable(20),t.alphaToCoverage&&o.enable(21),t.numLightProbeGrids>0&&o.enable(22),t.hasPositionAttribute&&o.enable(23),e.push(o.mask)}function v(e){let t=f[e.type],n;if(t){let e=W_[t];n=lg.clone(e.uniforms)}else n=e.uniforms;return n}function y(t,n){let r=u.get(n);return r===void 0?(r=new db(e,n,t,i),l.push(r),u.set(n,r)):++r.usedTimes,r}function b(e){if(--e.usedTimes===0){let t=l.indexOf(e);l[t]=l[l.length-1],l.pop(),u.delete(e.cacheKey),e.destroy()}}function x(e){s.remove(e)}function S(){s.dispose()}return{getParameters:m,getProgramCacheKey:h,getUniforms:v,acquireProgram:y,releaseProgram:b,releaseShaderCache:x,programs:l,dispose:S}}function _b(){let e=new WeakMap;function t(t){return e.has(t)}function n(t){let n=e.get(t);return n===void 0&&(n={},e.set(t,n)),n}function r(t){e.delete(t)}function i(t,n,r){e.get(t)[n]=r}function a(){e=new WeakMap}return{has:t,get:n,remove:r,update:i,dispose:a}}function vb(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.material.id===t.material.id?e.materialVariant===t.materialVariant?e.z===t.z?e.id-t.id:e.z-t.z:e.materialVariant-t.materialVariant:e.material.id-t.material.id:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function yb(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.z===t.z?e.id-t.id:t.z-e.z:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function bb(){let e=[],t=0,n=[],r=[],i=[];function a(){t=0,n.length=0,r.length=0,i.length=0}function o(e){let t=0;return e.isInstancedMesh&&(t+=2),e.isSkinnedMesh&&(t+=1),t}function s(n,r,i,a,s,c){let l=e[t];return l===void 0?(l={id:n.id,object:n,geometry:r,material:i,materialVariant:o(n),groupOrder:a,renderOrder:n.renderOrder,z:s,group:c},e[t]=l):(l.id=n.id,l.object=n,l.geometry=r,l.material=i,l.materialVariant=o(n),l.groupOrder=a,l.renderOrder=n.renderOrder,l.z=s,l.group=c),t++,l}function c(e,t,a,o,c,l,u){u.reversedDepth===!0&&(c=-c);let d=s(e,t,a,o,c,l);a.transmission>0?r.push(d):a.transparent===!0?i.push(d):n.push(d)}function l(e,t,a,o,c,l){let u=s(e,t,a,o,c,l);a.transmission>0?r.unshift(u):a.transparent===!0?i.unshift(u):n.unshift(u)}function u(e,t){n.length>1&&n.sort(e||vb),r.length>1&&r.sort(t||yb),i.length>1&&i.sort(t||yb)}function d(){for(let n=t,r=e.length;n<r;n++){let t=e[n];if(t.id===null)break;t.id=null,t.object=null,t.geometry=null,t.material=null,t.group=null}}return{opaque:n,transmissive:r,transparent:i,init:a,push:c,unshift:l,finish:d,sort:u}}function xb(){let e=new WeakMap;function t(t,n){let r=e.get(t),i;return r===void 0?(i=new bb,e.set(t,[i])):n>=r.length?(i=new bb,r.push(i)):i=r[n],i}function n(){e=new WeakMap}return{get:t,dispose:n}}function Sb(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={direction:new X,color:new Z};break;case`SpotLight`:n={position:new X,direction:new X,color:new Z,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case`PointLight`:n={position:new X,color:new Z,distance:0,decay:0};break;case`HemisphereLight`:n={direction:new X,skyColor:new Z,groundColor:new Z};break;case`RectAreaLight`:n={color:new Z,position:new X,halfWidth:new X,halfHeight:new X}}return e[t.id]=n,n}}}function Cb(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Y};break;case`SpotLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Y};break;case`PointLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Y,shadowCameraNear:1,shadowCameraFar:1e3}}return e[t.id]=n,n}}}var wb=0;function Tb(e,t){return(t.castShadow?2:0)-(e.castShadow?2:0)+ +!!t.map-!!e.map}function Eb(e){let t=new Sb,n=Cb(),r={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let e=0;e<9;e++)r.probe.push(new X);let i=new X,a=new Nd,o=new Nd;function s(i){let a=0,o=0,s=0;for(let e=0;e<9;e++)r.probe[e].set(0,0,0);let c=0,l=0,u=0,d=0,f=0,p=0,m=0,h=0,g=0,_=0,v=0,y=0,b=0,x=0;i.sort(Tb);for(let e=0,S=i.length;e<S;e++){let S=i[e],C=S.color,w=S.intensity,T=S.distance,E=null;if(S.shadow&&S.shadow.map&&(E=S.shadow.map.texture.format===1030?S.shadow.map.texture:S.shadow.map.depthTexture||S.shadow.map.texture),S.isAmbientLight)a+=C.r*w,o+=C.g*w,s+=C.b*w;else if(S.isLightProbe){for(let e=0;e<9;e++)r.probe[e].addScaledVector(S.sh.coefficients[e],w);x++}else if(S.isSunLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize.copy(e.mapSize).multiply(e.getFrameExtents()),r.sunShadow[l]=t,r.sunShadowMap[l]=E;let i=e.getViewportCount();for(let t=0;t<i;t++)r.sunShadowMatrix[u+t]=e.getMatrix(t),r.sunShadowCascade[u+t]=e._cascadeData[t];u+=i,l++}r.sun[c]=e,c++}else if(S.isDirectionalLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,r.directionalShadow[d]=t,r.directionalShadowMap[d]=E,r.directionalShadowMatrix[d]=S.shadow.matrix,g++}r.directional[d]=e,d++}else if(S.isSpotLight){let e=t.get(S);e.position.setFromMatrixPosition(S.matrixWorld),e.color.copy(C).multiplyScalar(w),e.distance=T,e.coneCos=Math.cos(S.angle),e.penumbraCos=Math.cos(S.angle*(1-S.penumbra)),e.decay=S.decay,r.spot[p]=e;let i=S.shadow;if(S.map&&(r.spotLightMap[y]=S.map,y++,i.updateMatrices(S),S.castShadow&&b++),r.spotLightMatrix[p]=i.matrix,S.castShadow){let e=n.get(S);e.shadowIntensity=i.intensity,e.shadowBias=i.bias,e.shadowNormalBias=i.normalBias,e.shadowRadius=i.radius,e.shadowMapSize=i.mapSize,r.spotShadow[p]=e,r.spotShadowMap[p]=E,v++}p++}else if(S.isRectAreaLight){let e=t.get(S);e.color.copy(C).multiplyScalar(w),e.halfWidth.set(S.width*.5,0,0),e.halfHeight.set(0,S.height*.5,0),r.rectArea[m]=e,m++}else if(S.isPointLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),e.distance=S.distance,e.decay=S.decay,S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,t.shadowCameraNear=e.camera.near,t.shadowCameraFar=e.camera.far,r.pointShadow[f]=t,r.pointShadowMap[f]=E,r.pointShadowMatrix[f]=S.shadow.matrix,_++}r.point[f]=e,f++}else if(S.isHemisphereLight){let e=t.get(S);e.skyColor.copy(S.color).multiplyScalar(w),e.groundColor.copy(S.groundColor).multiplyScalar(w),r.hemi[h]=e,h++}}m>0&&(e.has(`OES_texture_float_linear`)===!0?(r.rectAreaLTC1=$.LTC_FLOAT_1,r.rectAreaLTC2=$.LTC_FLOAT_2):(r.rectAreaLTC1=$.LTC_HALF_1,r.rectAreaLTC2=$.LTC_HALF_2)),r.ambient[0]=a,r.ambient[1]=o,r.ambient[2]=s;let S=r.hash;(S.sunLength!==c||S.directionalLength!==d||S.pointLength!==f||S.spotLength!==p||S.rectAreaLength!==m||S.hemiLength!==h||S.numSunShadows!==l||S.numDirectionalShadows!==g||S.numPointShadows!==_||S.numSpotShadows!==v||S.numSpotMaps!==y||S.numLightProbes!==x)&&(r.sun.length=c,r.directional.length=d,r.spot.length=p,r.rectArea.length=m,r.point.length=f,r.hemi.length=h,r.sunShadow.length=l,r.sunShadowMap.length=l,r.sunShadowMatrix.length=u,r.sunShadowCascade.length=u,r.directionalShadow.length=g,r.directionalShadowMap.length=g,r.directionalShadowMatrix.length=g,r.pointShadow.length=_,r.pointShadowMap.length=_,r.pointShadowMatrix.length=_,r.spotShadow.length=v,r.spotShadowMap.length=v,r.spotLightMatrix.length=v+y-b,r.spotLightMap.length=y,r.numSpotLightShadowsWithMaps=b,r.numLightProbes=x,S.sunLength=c,S.directionalLength=d,S.pointLength=f,S.spotLength=p,S.rectAreaLength=m,S.hemiLength=h,S.numSunShadows=l,S.numDirectionalShadows=g,S.numPointShadows=_,S.numSpotShadows=v,S.numSpotMaps=y,S.numLightProbes=x,r.version=wb++)}function c(e,t){let n=0,s=0,c=0,l=0,u=0,d=0,f=t.matrixWorldInverse;for(let t=0,p=e.length;t<p;t++){let p=e[t];if(p.isSunLight){let e=r.sun[n];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),n++}else if(p.isDirectionalLight){let e=r.directional[s];e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),s++}else if(p.isSpotLight){let e=r.spot[l];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),l++}else if(p.isRectAreaLight){let e=r.rectArea[u];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),o.identity(),a.copy(p.matrixWorld),a.premultiply(f),o.extractRotation(a),e.halfWidth.set(p.width*.5,0,0),e.halfHeight.set(0,p.height*.5,0),e.halfWidth.applyMatrix4(o),e.halfHeight.applyMatrix4(o),u++}else if(p.isPointLight){let e=r.point[c];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),c++}else if(p.isHemisphereLight){let e=r.hemi[d];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),d++}}}return{setup:s,setupView:c,state:r}}function Db(e){let t=new Eb(e),n=[],r=[],i=[];function a(e){u.camera=e,n.length=0,r.length=0,i.length=0}function o(e){e.isLightProbeGrid?i.push(e):n.push(e)}function s(e){r.push(e)}function c(){t.setup(n),i.sort((e,t)=>e.priority-t.priority||e.id-t.id)}function l(e){t.setupView(n,e)}let u={lightsArray:n,shadowsArray:r,lightProbeGridArray:i,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:a,state:u,setupLights:c,setupLightsView:l,pushLight:o,pushShadow:s}}function Ob(e){let t=new WeakMap;function n(n,r=0){let i=t.get(n),a;return i===void 0?(a=new Db(e),t.set(n,[a])):r>=i.length?(a=new Db(e),i.push(a)):a=i[r],a}function r(){t=new WeakMap}return{get:n,dispose:r}}var kb=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,Ab=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,jb=[new X(1,0,0),new X(-1,0,0),new X(0,1,0),new X(0,-1,0),new X(0,0,1),new X(0,0,-1)],Mb=[new X(0,-1,0),new X(0,-1,0),new X(0,0,1),new X(0,0,-1),new X(0,-1,0),new X(0,-1,0)],Nb=new Nd,Pb=new X,Fb=new X;function Ib(e,t,n){let r=new $p,i=new Y,a=new Y,o=new Od,s=new gg,c=new _g,l={},u=n.maxTextureSize,d={0:1,1:0,2:2},f=new fg({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new Y},radius:{value:4}},vertexShader:kb,fragmentShader:Ab}),p=f.clone();p.defines.HORIZONTAL_PASS=1;let m=new lp;m.setAttribute(`position`,new Yf(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let h=new Lp(m,f),g=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=1;let _=this.type;this.render=function(t,n,s){if(g.enabled===!1||g.autoUpdate===!1&&g.needsUpdate===!1||t.length===0)return;this.type===2&&(K(`WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead.`),this.type=1);let c=e.getRenderTarget(),l=e.getActiveCubeFace(),d=e.getActiveMipmapLevel(),f=e.state;f.setBlending(0),f.buffers.depth.getReversed()===!0?f.buffers.color.setClear(0,0,0,0):f.buffers.color.setClear(1,1,1,1),f.buffers.depth.setTest(!0),f.setScissorTest(!1);let p=_!==this.type;p&&n.traverse(function(e){e.material&&(Array.isArray(e.material)?e.material.forEach(e=>e.needsUpdate=!0):e.material.needsUpdate=!0)});for(let c=0,l=t.length;c<l;c++){let l=t[c],d=l.shadow;if(d===void 0){K(`WebGLShadowMap:`,l,`has no shadow.`);continue}if(d.autoUpdate===!1&&d.needsUpdate===!1)continue;i.copy(d.mapSize);let m=d.getFrameExtents();i.multiply(m),a.copy(d.mapSize),(i.x>u||i.y>u)&&(i.x>u&&(a.x=Math.floor(u/m.x),i.x=a.x*m.x,d.mapSize.x=a.x),i.y>u&&(a.y=Math.floor(u/m.y),i.y=a.y*m.y,d.mapSize.y=a.y));let h=e.state.buffers.depth.getReversed();if(d.camera._reversedDepth=h,d.map===null||p===!0){if(d.map!==null&&(d.map.depthTexture!==null&&(d.map.depthTexture.dispose(),d.map.depthTexture=null),d.map.dispose()),this.type===3){if(l.isPointLight){K(`WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.`);continue}d.map=new Ad(i.x,i.y,{format:wl,type:dl,minFilter:tl,magFilter:tl,generateMipmaps:!1}),d.map.texture.name=l.name+`.shadowMap`,d.map.depthTexture=new vm(i.x,i.y,ul),d.map.depthTexture.name=l.name+`.shadowMapDepth`,d.map.depthTexture.format=bl,d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=Qc,d.map.depthTexture.magFilter=Qc}else l.isPointLight?(d.map=new $_(i.x),d.map.depthTexture=new ym(i.x,ll)):(d.map=new Ad(i.x,i.y),d.map.depthTexture=new vm(i.x,i.y,ll)),d.map.depthTexture.name=l.name+`.shadowMap`,d.map.depthTexture.format=bl,this.type===1?(d.map.depthTexture.compareFunction=h?518:515,d.map.depthTexture.minFilter=tl,d.map.depthTexture.magFilter=tl):(d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=Qc,d.map.depthTexture.magFilter=Qc);d.camera.updateProjectionMatrix()}d.map.isWebGLCubeRenderTarget!==!0&&(d.map.width!==i.x||d.map.height!==i.y)&&d.map.setSize(i.x,i.y);let g=d.map.isWebGLCubeRenderTarget?6:d.getViewportCount();l.isPointLight!==!0&&d.updateMatrices(l,s);let _=d.camera.layers.mask&4294967294?d.camera.layers:s.layers;for(let t=0;t<g;t++){let i=d.getCamera(t);if(l.isPointLight){let e=d.camera,n=d.matrix,r=l.distance||e.far;r!==e.far&&(e.far=r,e.updateProjectionMatrix()),Pb.setFromMatrixPosition(l.matrixWorld),e.position.copy(Pb),Fb.copy(e.position),Fb.add(jb[t]),e.up.copy(Mb[t]),e.lookAt(Fb),e.updateMatrixWorld(),n.makeTranslation(-Pb.x,-Pb.y,-Pb.z),Nb.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),d._frustum.setFromProjectionMatrix(Nb,e.coordinateSystem,e.reversedDepth)}if(d.map.isWebGLCubeRenderTarget)e.setRenderTarget(d.map,t),e.clear();else{t===0&&(e.setRenderTarget(d.map),e.clear());let n=d.getViewport(t);o.set(a.x*n.x,a.y*n.y,a.x*n.z,a.y*n.w),f.viewport(o)}r=d.getFrustum(t),b(n,s,i,l,_,this.type)}d.isPointLightShadow!==!0&&this.type===3&&v(d,s),d.needsUpdate=!1}_=this.type,g.needsUpdate=!1,e.setRenderTarget(c,l,d)};function v(n,r){let a=t.update(h);f.defines.VSM_SAMPLES!==n.blurSamples&&(f.defines.VSM_SAMPLES=n.blurSamples,p.defines.VSM_SAMPLES=n.blurSamples,f.needsUpdate=!0,p.needsUpdate=!0),n.mapPass===null?n.mapPass=new Ad(i.x,i.y,{format:wl,type:dl}):(n.mapPass.width!==n.map.width||n.mapPass.height!==n.map.height)&&n.mapPass.setSize(n.map.width,n.map.height),f.uniforms.shadow_pass.value=n.map.depthTexture,f.uniforms.resolution.value.set(n.map.width,n.map.height),f.uniforms.radius.value=n.radius,e.setRenderTarget(n.mapPass),e.clear(),e.renderBufferDirect(r,null,a,f,h,null),p.uniforms.shadow_pass.value=n.mapPass.texture,p.uniforms.resolution.value.set(n.map.width,n.map.height),p.uniforms.radius.value=n.radius,e.setRenderTarget(n.map),e.clear(),e.renderBufferDirect(r,null,a,p,h,null)}function y(t,n,r,i){let a=null,o=r.isPointLight===!0?t.customDistanceMaterial:t.customDepthMaterial;if(o!==void 0)a=o;else if(a=r.isPointLight===!0?c:s,e.localClippingEnabled&&n.clipShadows===!0&&Array.isArray(n.clippingPlanes)&&n.clippingPlanes.length!==0||n.displacementMap&&n.displacementScale!==0||n.alphaMap&&n.alphaTest>0||n.map&&n.alphaTest>0||n.alphaToCoverage===!0){let e=a.uuid,t=n.uuid,r=l[e];r===void 0&&(r={},l[e]=r);let i=r[t];i===void 0&&(i=a.clone(),r[t]=i,n.addEventListener(`dispose`,x)),a=i}if(a.visible=n.visible,a.wireframe=n.wireframe,i===3?a.side=n.shadowSide===null?n.side:n.shadowSide:a.side=n.shadowSide===null?d[n.side]:n.shadowSide,a.alphaMap=n.alphaMap,a.alphaTest=n.alphaToCoverage===!0?.5:n.alphaTest,a.map=n.map,a.clipShadows=n.clipShadows,a.clippingPlanes=n.clippingPlanes,a.clipIntersection=n.clipIntersection,a.displacementMap=n.displacementMap,a.displacementScale=n.displacementScale,a.displacementBias=n.displacementBias,a.wireframeLinewidth=n.wireframeLinewidth,a.linewidth=n.linewidth,r.isPointLight===!0&&a.isMeshDistanceMaterial===!0){let t=e.properties.get(a);t.light=r}return a}function b(n,i,a,o,s,c){if(n.visible===!1)return;if(n.layers.test(s)&&(n.isMesh||n.isLine||n.isPoints)&&(n.castShadow||n.receiveShadow&&c===3)&&(!n.frustumCulled||n.intersectsFrustum(r))){n.modelViewMatrix.multiplyMatrices(a.matrixWorldInverse,n.matrixWorld);let r=t.update(n),s=n.material;if(Array.isArray(s)){let t=r.groups;for(let l=0,u=t.length;l<u;l++){let u=t[l],d=s[u.materialIndex];if(d&&d.visible){let t=y(n,d,o,c);n.onBeforeShadow(e,n,i,a,r,t,u),e.renderBufferDirect(a,null,r,t,n,u),n.onAfterShadow(e,n,i,a,r,t,u)}}}else if(s.visible){let t=y(n,s,o,c);n.onBeforeShadow(e,n,i,a,r,t,null),e.renderBufferDirect(a,null,r,t,n,null),n.onAfterShadow(e,n,i,a,r,t,null)}}let l=n.children;for(let e=0,t=l.length;e<t;e++)b(l[e],i,a,o,s,c)}function x(e){e.target.removeEventListener(`dispose`,x);for(let t in l){let n=l[t],r=e.target.uuid;r in n&&(n[r].dispose(),delete n[r])}}}function Lb(e,t){function n(){let t=!1,n=new Od,r=null,i=new Od(0,0,0,0);return{setMask:function(n){r!==n&&!t&&(e.colorMask(n,n,n,n),r=n)},setLocked:function(e){t=e},setClear:function(t,r,a,o,s){s===!0&&(t*=o,r*=o,a*=o),n.set(t,r,a,o),i.equals(n)===!1&&(e.clearColor(t,r,a,o),i.copy(n))},reset:function(){t=!1,r=null,i.set(-1,0,0,0)}}}function r(){let n=!1,r=!1,i=null,a=null,o=null;return{setReversed:function(e){if(r!==e){let n=t.get(`EXT_clip_control`);e?n.clipControlEXT(n.LOWER_LEFT_EXT,n.ZERO_TO_ONE_EXT):n.clipControlEXT(n.LOWER_LEFT_EXT,n.NEGATIVE_ONE_TO_ONE_EXT),r=e;let i=o;o=null,this.setClear(i)}},getReversed:function(){return r},setTest:function(t){t?z(e.DEPTH_TEST):ae(e.DEPTH_TEST)},setMask:function(t){i!==t&&!n&&(e.depthMask(t),i=t)},setFunc:function(t){if(r&&(t=Pu[t]),a!==t){switch(t){case 0:e.depthFunc(e.NEVER);break;case 1:e.depthFunc(e.ALWAYS);break;case 2:e.depthFunc(e.LESS);break;case 3:e.depthFunc(e.LEQUAL);break;case 4:e.depthFunc(e.EQUAL);break;case 5:e.depthFunc(e.GEQUAL);break;case 6:e.depthFunc(e.GREATER);break;case 7:e.depthFunc(e.NOTEQUAL);break;default:e.depthFunc(e.LEQUAL)}a=t}},setLocked:function(e){n=e},setClear:function(t){o!==t&&(o=t,r&&(t=1-t),e.clearDepth(t))},reset:function(){n=!1,i=null,a=null,o=null,r=!1}}}function i(){let t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null;return{setTest:function(n){t||(n?z(e.STENCIL_TEST):ae(e.STENCIL_TEST))},setMask:function(r){n!==r&&!t&&(e.stencilMask(r),n=r)},setFunc:function(t,n,o){(r!==t||i!==n||a!==o)&&(e.stencilFunc(t,n,o),r=t,i=n,a=o)},setOp:function(t,n,r){(o!==t||s!==n||c!==r)&&(e.stencilOp(t,n,r),o=t,s=n,c=r)},setLocked:function(e){t=e},setClear:function(t){l!==t&&(e.clearStencil(t),l=t)},reset:function(){t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null}}}let a=new n,o=new r,s=new i,c={},l=new WeakMap,u={},d={},f={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new Z(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,M=e.getParameter(e.MAX_COMBINED_TEXTURE_IMAGE_UNITS),N=!1,ee=0,te=e.getParameter(e.VERSION);te.indexOf(`WebGL`)===-1?te.indexOf(`OpenGL ES`)!==-1&&(ee=parseFloat(/^OpenGL ES (\d)/.exec(te)[1]),N=ee>=2):(ee=parseFloat(/^WebGL (\d)/.exec(te)[1]),N=ee>=1);let ne=null,re={},P=e.getParameter(e.SCISSOR_BOX),F=e.getParameter(e.VIEWPORT),ie=new Od().fromArray(P),I=new Od().fromArray(F);function L(t,n,r,i){let a=new Uint8Array(4),o=e.createTexture();e.bindTexture(t,o),e.texParameteri(t,e.TEXTURE_MIN_FILTER,e.NEAREST),e.texParameteri(t,e.TEXTURE_MAG_FILTER,e.NEAREST);for(let o=0;o<r;o++)t===e.TEXTURE_3D||t===e.TEXTURE_2D_ARRAY?e.texImage3D(n,0,e.RGBA,1,1,i,0,e.RGBA,e.UNSIGNED_BYTE,a):e.texImage2D(n+o,0,e.RGBA,1,1,0,e.RGBA,e.UNSIGNED_BYTE,a);return o}let R={};R[e.TEXTURE_2D]=L(e.TEXTURE_2D,e.TEXTURE_2D,1),R[e.TEXTURE_CUBE_MAP]=L(e.TEXTURE_CUBE_MAP,e.TEXTURE_CUBE_MAP_POSITIVE_X,6),R[e.TEXTURE_2D_ARRAY]=L(e.TEXTURE_2D_ARRAY,e.TEXTURE_2D_ARRAY,1,1),R[e.TEXTURE_3D]=L(e.TEXTURE_3D,e.TEXTURE_3D,1,1),a.setClear(0,0,0,1),o.setClear(1),s.setClear(0),z(e.DEPTH_TEST),o.setFunc(3),pe(!1),me(1),z(e.CULL_FACE),de(0);function z(t){u[t]!==!0&&(e.enable(t),u[t]=!0)}function ae(t){u[t]!==!1&&(e.disable(t),u[t]=!1)}function oe(t,n){return f[t]!==n&&(e.bindFramebuffer(t,n),f[t]=n,t===e.DRAW_FRAMEBUFFER&&(f[e.FRAMEBUFFER]=n),t===e.FRAMEBUFFER&&(f[e.DRAW_FRAMEBUFFER]=n),!0)}function se(t,n){let r=m,i=!1;if(t){r=p.get(n),r===void 0&&(r=[],p.set(n,r));let a=t.textures;if(r.length!==a.length||r[0]!==e.COLOR_ATTACHMENT0){for(let t=0,n=a.length;t<n;t++)r[t]=e.COLOR_ATTACHMENT0+t;r.length=a.length,i=!0}}else r[0]!==e.BACK&&(r[0]=e.BACK,i=!0);i&&e.drawBuffers(r)}function ce(t){return h!==t&&(e.useProgram(t),h=t,!0)}let le={100:e.FUNC_ADD,101:e.FUNC_SUBTRACT,102:e.FUNC_REVERSE_SUBTRACT};le[103]=e.MIN,le[104]=e.MAX;let ue={200:e.ZERO,201:e.ONE,202:e.SRC_COLOR,204:e.SRC_ALPHA,210:e.SRC_ALPHA_SATURATE,208:e.DST_COLOR,206:e.DST_ALPHA,203:e.ONE_MINUS_SRC_COLOR,205:e.ONE_MINUS_SRC_ALPHA,209:e.ONE_MINUS_DST_COLOR,207:e.ONE_MINUS_DST_ALPHA,211:e.CONSTANT_COLOR,212:e.ONE_MINUS_CONSTANT_COLOR,213:e.CONSTANT_ALPHA,214:e.ONE_MINUS_CONSTANT_ALPHA};function de(t,n,r,i,a,o,s,c,l,u){if(t===0)g===!0&&(ae(e.BLEND),g=!1);else if(g===!1&&(z(e.BLEND),g=!0),t!==5){if(t!==_||u!==E){if((v!==100||x!==100)&&(e.blendEquation(e.FUNC_ADD),v=100,x=100),u)switch(t){case 1:e.blendFuncSeparate(e.ONE,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFunc(e.ONE,e.ONE);break;case 3:e.blendFuncSeparate(e.ZERO,e.ONE_MINUS_SRC_COLOR,e.ZERO,e.ONE);break;case 4:e.blendFuncSeparate(e.DST_COLOR,e.ONE_MINUS_SRC_ALPHA,e.ZERO,e.ONE);break;default:q(`WebGLState: Invalid blending: `,t)}else switch(t){case 1:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE,e.ONE,e.ONE);break;case 3:q(`WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true`);break;case 4:q(`WebGLState: MultiplyBlending requires material.premultipliedAlpha = true`);break;default:q(`WebGLState: Invalid blending: `,t)}y=null,b=null,S=null,C=null,w.set(0,0,0),T=0,_=t,E=u}}else a||=n,o||=r,s||=i,(n!==v||a!==x)&&(e.blendEquationSeparate(le[n],le[a]),v=n,x=a),(r!==y||i!==b||o!==S||s!==C)&&(e.blendFuncSeparate(ue[r],ue[i],ue[o],ue[s]),y=r,b=i,S=o,C=s),(c.equals(w)===!1||l!==T)&&(e.blendColor(c.r,c.g,c.b,l),w.copy(c),T=l),_=t,E=!1}function fe(t,n){t.side===2?ae(e.CULL_FACE):z(e.CULL_FACE);let r=t.side===1;n&&(r=!r),pe(r),t.blending===1&&t.transparent===!1?de(0):de(t.blending,t.blendEquation,t.blendSrc,t.blendDst,t.blendEquationAlpha,t.blendSrcAlpha,t.blendDstAlpha,t.blendColor,t.blendAlpha,t.premultipliedAlpha),o.setFunc(t.depthFunc),o.setTest(t.depthTest),o.setMask(t.depthWrite),a.setMask(t.colorWrite);let i=t.stencilWrite;s.setTest(i),i&&(s.setMask(t.stencilWriteMask),s.setFunc(t.stencilFunc,t.stencilRef,t.stencilFuncMask),s.setOp(t.stencilFail,t.stencilZFail,t.stencilZPass)),ge(t.polygonOffset,t.polygonOffsetFactor,t.polygonOffsetUnits),t.alphaToCoverage===!0?z(e.SAMPLE_ALPHA_TO_COVERAGE):ae(e.SAMPLE_ALPHA_TO_COVERAGE)}function pe(t){D!==t&&(t?e.frontFace(e.CW):e.frontFace(e.CCW),D=t)}function me(t){t===0?ae(e.CULL_FACE):(z(e.CULL_FACE),t!==O&&(t===1?e.cullFace(e.BACK):t===2?e.cullFace(e.FRONT):e.cullFace(e.FRONT_AND_BACK))),O=t}function he(t){t!==k&&(N&&e.lineWidth(t),k=t)}function ge(t,n,r){t?(z(e.POLYGON_OFFSET_FILL),(A!==n||j!==r)&&(A=n,j=r,o.getReversed()&&(n=-n,r=-r),e.polygonOffset(n,r))):ae(e.POLYGON_OFFSET_FILL)}function _e(t){t?z(e.SCISSOR_TEST):ae(e.SCISSOR_TEST)}function ve(t){t===void 0&&(t=e.TEXTURE0+M-1),ne!==t&&(e.activeTexture(t),ne=t)}function B(t,n,r){r===void 0&&(r=ne===null?e.TEXTURE0+M-1:ne);let i=re[r];i===void 0&&(i={type:void 0,texture:void 0},re[r]=i),(i.type!==t||i.texture!==n)&&(ne!==r&&(e.activeTexture(r),ne=r),e.bindTexture(t,n||R[t]),i.type=t,i.texture=n)}function V(){let t=re[ne];t!==void 0&&t.type!==void 0&&(e.bindTexture(t.type,null),t.type=void 0,t.texture=void 0)}function H(){try{e.compressedTexImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function ye(){try{e.compressedTexImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function U(){try{e.texSubImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function be(){try{e.texSubImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function W(){try{e.compressedTexSubImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function G(){try{e.compressedTexSubImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function xe(){try{e.texStorage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function Se(){try{e.texStorage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function Ce(){try{e.texImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function we(){try{e.texImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function Te(t){return d[t]===void 0?e.getParameter(t):d[t]}function Ee(t,n){d[t]!==n&&(e.pixelStorei(t,n),d[t]=n)}function De(t){ie.equals(t)===!1&&(e.scissor(t.x,t.y,t.z,t.w),ie.copy(t))}function Oe(t){I.equals(t)===!1&&(e.viewport(t.x,t.y,t.z,t.w),I.copy(t))}function ke(t,n){let r=l.get(n);r===void 0&&(r=new WeakMap,l.set(n,r));let i=r.get(t);i===void 0&&(i=e.getUniformBlockIndex(n,t.name),e.uniformBlockBinding(n,i,i),r.set(t,i))}function Ae(t,n,r){let i=l.get(n).get(t);c[i]!==r&&(e.bindBufferBase(e.UNIFORM_BUFFER,i,r),c[i]=r)}function je(){e.disable(e.BLEND),e.disable(e.CULL_FACE),e.disable(e.DEPTH_TEST),e.disable(e.POLYGON_OFFSET_FILL),e.disable(e.SCISSOR_TEST),e.disable(e.STENCIL_TEST),e.disable(e.SAMPLE_ALPHA_TO_COVERAGE),e.blendEquation(e.FUNC_ADD),e.blendFunc(e.ONE,e.ZERO),e.blendFuncSeparate(e.ONE,e.ZERO,e.ONE,e.ZERO),e.blendColor(0,0,0,0),e.colorMask(!0,!0,!0,!0),e.clearColor(0,0,0,0),e.depthMask(!0),e.depthFunc(e.LESS),o.setReversed(!1),e.clearDepth(1),e.stencilMask(4294967295),e.stencilFunc(e.ALWAYS,0,4294967295),e.stencilOp(e.KEEP,e.KEEP,e.KEEP),e.clearStencil(0),e.cullFace(e.BACK),e.frontFace(e.CCW),e.polygonOffset(0,0),e.activeTexture(e.TEXTURE0),e.bindFramebuffer(e.FRAMEBUFFER,null),e.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),e.bindFramebuffer(e.READ_FRAMEBUFFER,null),e.useProgram(null),e.lineWidth(1),e.scissor(0,0,e.canvas.width,e.canvas.height),e.viewport(0,0,e.canvas.width,e.canvas.height),e.pixelStorei(e.PACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,!1),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),e.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,e.BROWSER_DEFAULT_WEBGL),e.pixelStorei(e.PACK_ROW_LENGTH,0),e.pixelStorei(e.PACK_SKIP_PIXELS,0),e.pixelStorei(e.PACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_ROW_LENGTH,0),e.pixelStorei(e.UNPACK_IMAGE_HEIGHT,0),e.pixelStorei(e.UNPACK_SKIP_PIXELS,0),e.pixelStorei(e.UNPACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_SKIP_IMAGES,0),u={},d={},ne=null,re={},f={},c={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new Z(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,ie.set(0,0,e.canvas.width,e.canvas.height),I.set(0,0,e.canvas.width,e.canvas.height),a.reset(),o.reset(),s.reset()}return{buffers:{color:a,depth:o,stencil:s},enable:z,disable:ae,bindFramebuffer:oe,drawBuffers:se,useProgram:ce,setBlending:de,setMaterial:fe,setFlipSided:pe,setCullFace:me,setLineWidth:he,setPolygonOffset:ge,setScissorTest:_e,activeTexture:ve,bindTexture:B,unbindTexture:V,compressedTexImage2D:H,compressedTexImage3D:ye,texImage2D:Ce,texImage3D:we,pixelStorei:Ee,getParameter:Te,updateUBOMapping:ke,uniformBlockBinding:Ae,texStorage2D:xe,texStorage3D:Se,texSubImage2D:U,texSubImage3D:be,compressedTexSubImage2D:W,compressedTexSubImage3D:G,scissor:De,viewport:Oe,reset:je}}function Rb(e,t,n,r,i,a,o){let s=t.has(`WEBGL_multisampled_render_to_texture`)?t.get(`WEBGL_multisampled_render_to_texture`):null,c=typeof navigator>`u`?!1:/OculusBrowser/g.test(navigator.userAgent),l=new Y,u=new WeakMap,d=new Set,f,p=new WeakMap,m=new Set,h=new FinalizationRegistry(e=>m.delete(e)),g=!1;try{g=typeof OffscreenCanvas<`u`&&new OffscreenCanvas(1,1).getContext(`2d`)!==null}catch{}function _(e,t){return g?new OffscreenCanvas(e,t):Du(`canvas`)}function v(e,t,n){let r=1,i=xe(e);if((i.width>n||i.height>n)&&(r=n/Math.max(i.width,i.height)),r<1){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap||typeof VideoFrame<`u`&&e instanceof VideoFrame){let n=Math.floor(r*i.width),a=Math.floor(r*i.height);f===void 0&&(f=_(n,a));let o=t?_(n,a):f;return o.width=n,o.height=a,o.getContext(`2d`).drawImage(e,0,0,n,a),K(`WebGLRenderer: Texture has been resized from (`+i.width+`x`+i.height+`) to (`+n+`x`+a+`).`),o}return`data`in e&&K(`WebGLRenderer: Image in DataTexture is too big (`+i.width+`x`+i.height+`).`),e}return e}function y(e){return e.generateMipmaps}function b(t){e.generateMipmap(t)}function x(t){return t.isWebGLCubeRenderTarget?e.TEXTURE_CUBE_MAP:t.isWebGL3DRenderTarget?e.TEXTURE_3D:t.isWebGLArrayRenderTarget||t.isCompressedArrayTexture?e.TEXTURE_2D_ARRAY:e.TEXTURE_2D}function S(n,r,i,a,o,s=!1){if(n!==null){if(e[n]!==void 0)return e[n];K(`WebGLRenderer: Attempt to use non-existing WebGL internal format '`+n+`'`)}let c;a&&(c=t.get(`EXT_texture_norm16`),c||K(`WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension`));let l=r;if(r===e.RED&&(i===e.FLOAT&&(l=e.R32F),i===e.HALF_FLOAT&&(l=e.R16F),i===e.UNSIGNED_BYTE&&(l=e.R8),i===e.UNSIGNED_SHORT&&c&&(l=c.R16_EXT),i===e.SHORT&&c&&(l=c.R16_SNORM_EXT)),r===e.RED_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.R8UI),i===e.UNSIGNED_SHORT&&(l=e.R16UI),i===e.UNSIGNED_INT&&(l=e.R32UI),i===e.BYTE&&(l=e.R8I),i===e.SHORT&&(l=e.R16I),i===e.INT&&(l=e.R32I)),r===e.RG&&(i===e.FLOAT&&(l=e.RG32F),i===e.HALF_FLOAT&&(l=e.RG16F),i===e.UNSIGNED_BYTE&&(l=e.RG8),i===e.UNSIGNED_SHORT&&c&&(l=c.RG16_EXT),i===e.SHORT&&c&&(l=c.RG16_SNORM_EXT)),r===e.RG_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RG8UI),i===e.UNSIGNED_SHORT&&(l=e.RG16UI),i===e.UNSIGNED_INT&&(l=e.RG32UI),i===e.BYTE&&(l=e.RG8I),i===e.SHORT&&(l=e.RG16I),i===e.INT&&(l=e.RG32I)),r===e.RGB_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGB8UI),i===e.UNSIGNED_SHORT&&(l=e.RGB16UI),i===e.UNSIGNED_INT&&(l=e.RGB32UI),i===e.BYTE&&(l=e.RGB8I),i===e.SHORT&&(l=e.RGB16I),i===e.INT&&(l=e.RGB32I)),r===e.RGBA_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGBA8UI),i===e.UNSIGNED_SHORT&&(l=e.RGBA16UI),i===e.UNSIGNED_INT&&(l=e.RGBA32UI),i===e.BYTE&&(l=e.RGBA8I),i===e.SHORT&&(l=e.RGBA16I),i===e.INT&&(l=e.RGBA32I)),r===e.RGB&&(i===e.UNSIGNED_SHORT&&c&&(l=c.RGB16_EXT),i===e.SHORT&&c&&(l=c.RGB16_SNORM_EXT),i===e.UNSIGNED_INT_5_9_9_9_REV&&(l=e.RGB9_E5),i===e.UNSIGNED_INT_10F_11F_11F_REV&&(l=e.R11F_G11F_B10F)),r===e.RGBA){let t=s?bu:_d.getTransfer(o);i===e.FLOAT&&(l=e.RGBA32F),i===e.HALF_FLOAT&&(l=e.RGBA16F),i===e.UNSIGNED_BYTE&&(l=t===`srgb`?e.SRGB8_ALPHA8:e.RGBA8),i===e.UNSIGNED_SHORT&&c&&(l=c.RGBA16_EXT),i===e.SHORT&&c&&(l=c.RGBA16_SNORM_EXT),i===e.UNSIGNED_SHORT_4_4_4_4&&(l=e.RGBA4),i===e.UNSIGNED_SHORT_5_5_5_1&&(l=e.RGB5_A1)}return(l===e.R16F||l===e.R32F||l===e.RG16F||l===e.RG32F||l===e.RGBA16F||l===e.RGBA32F)&&t.get(`EXT_color_buffer_float`),l}function C(t,n){let r;return t?n===null||n===1014||n===1020?r=e.DEPTH24_STENCIL8:n===1015?r=e.DEPTH32F_STENCIL8:n===1012&&(r=e.DEPTH24_STENCIL8,K(`DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.`)):n===null||n===1014||n===1020?r=e.DEPTH_COMPONENT24:n===1015?r=e.DEPTH_COMPONENT32F:n===1012&&(r=e.DEPTH_COMPONENT16),r}function w(e,t){return y(e)===!0||e.isFramebufferTexture&&e.minFilter!==1003&&e.minFilter!==1006?Math.log2(Math.max(t.width,t.height))+1:e.mipmaps.length>0?e.mipmaps.length:e.isCompressedTexture&&Array.isArray(e.image)?t.mipmaps.length:1}function T(e){let t=new WeakRef(e);r.get(e).__ref=t,m.add(t),h.register(e,t,t)}function E(e){let t=r.get(e).__ref;t!==void 0&&(m.delete(t),h.unregister(t))}function D(e){k(e.target)}function O(e){A(e.target)}function k(e){e.removeEventListener(`dispose`,D),E(e),M(e),e.isVideoTexture&&u.delete(e),e.isHTMLTexture&&d.delete(e)}function A(e){e.removeEventListener(`dispose`,O),E(e),ee(e)}function j(){for(let e of m){let t=e.deref();t!==void 0&&(t.isRenderTarget===!0?A(t):k(t))}m.clear(),d.clear()}function M(e){let t=r.get(e);if(t.__webglInit===void 0)return;let n=e.source,i=p.get(n);if(i){let r=i[t.__cacheKey];r.usedTimes--,r.usedTimes===0&&N(e),Object.keys(i).length===0&&p.delete(n)}r.remove(e)}function N(t){let n=r.get(t);e.deleteTexture(n.__webglTexture);let i=t.source,a=p.get(i);delete a[n.__cacheKey],o.memory.textures--}function ee(t){let n=r.get(t);n.__depthDisposeCallback&&n.__depthDisposeCallback();let i=t.depthTexture;if(i&&i.renderTarget===t&&k(i),t.isWebGLCubeRenderTarget)for(let t=0;t<6;t++){if(Array.isArray(n.__webglFramebuffer[t]))for(let r=0;r<n.__webglFramebuffer[t].length;r++)e.deleteFramebuffer(n.__webglFramebuffer[t][r]);else e.deleteFramebuffer(n.__webglFramebuffer[t]);n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer[t])}else{if(Array.isArray(n.__webglFramebuffer))for(let t=0;t<n.__webglFramebuffer.length;t++)e.deleteFramebuffer(n.__webglFramebuffer[t]);else e.deleteFramebuffer(n.__webglFramebuffer);if(n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer),n.__webglMultisampledFramebuffer&&e.deleteFramebuffer(n.__webglMultisampledFramebuffer),n.__webglColorRenderbuffer)for(let t=0;t<n.__webglColorRenderbuffer.length;t++)n.__webglColorRenderbuffer[t]&&e.deleteRenderbuffer(n.__webglColorRenderbuffer[t]);n.__webglDepthRenderbuffer&&e.deleteRenderbuffer(n.__webglDepthRenderbuffer)}let a=t.textures;for(let t=0,n=a.length;t<n;t++){let n=r.get(a[t]);n.__webglTexture&&(e.deleteTexture(n.__webglTexture),o.memory.textures--),r.remove(a[t])}r.remove(t)}let te=0;function ne(){te=0}function re(){return te}function P(e){te=e}function F(){let e=te;return e>=i.maxTextures&&K(`WebGLTextures: Trying to use `+(e+1)+` texture units while this GPU supports only `+i.maxTextures),te+=1,e}function ie(e){let t=[];return t.push(e.wrapS),t.push(e.wrapT),t.push(e.wrapR||0),t.push(e.magFilter),t.push(e.minFilter),t.push(e.anisotropy),t.push(e.internalFormat),t.push(e.format),t.push(e.type),t.push(e.generateMipmaps),t.push(e.mipmapsAutoUpdate),t.push(e.premultiplyAlpha),t.push(e.flipY),t.push(e.unpackAlignment),t.push(e.colorSpace),t.join()}function I(t,i){let a=r.get(t);if(t.isVideoTexture&&W(t),t.isRenderTargetTexture===!1&&t.isExternalTexture!==!0&&t.version>0&&a.__version!==t.version){let e=t.image;if(e===null)K(`WebGLRenderer: Texture marked for update but no image data found.`);else if(e.complete===!1)K(`WebGLRenderer: Texture marked for update but image is incomplete`);else{fe(a,t,i);return}}else t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null);n.bindTexture(e.TEXTURE_2D,a.__webglTexture,e.TEXTURE0+i)}function L(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?fe(a,t,i):(t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null),n.bindTexture(e.TEXTURE_2D_ARRAY,a.__webglTexture,e.TEXTURE0+i))}function R(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?fe(a,t,i):n.bindTexture(e.TEXTURE_3D,a.__webglTexture,e.TEXTURE0+i)}function z(t,i){let a=r.get(t);t.version>0&&a.__version!==t.version?pe(a,t,i):n.bindTexture(e.TEXTURE_CUBE_MAP,a.__webglTexture,e.TEXTURE0+i)}let ae={[Yc]:e.REPEAT,[Xc]:e.CLAMP_TO_EDGE,[Zc]:e.MIRRORED_REPEAT},oe={[Qc]:e.NEAREST,[$c]:e.NEAREST_MIPMAP_NEAREST,[el]:e.NEAREST_MIPMAP_LINEAR,[tl]:e.LINEAR,[nl]:e.LINEAR_MIPMAP_NEAREST,[rl]:e.LINEAR_MIPMAP_LINEAR},se={512:e.NEVER,519:e.ALWAYS,513:e.LESS,515:e.LEQUAL,514:e.EQUAL,518:e.GEQUAL,516:e.GREATER,517:e.NOTEQUAL};function ce(n,a){if(a.type===1015&&t.has(`OES_texture_float_linear`)===!1&&(a.magFilter===1006||a.magFilter===1007||a.magFilter===1005||a.magFilter===1008||a.minFilter===1006||a.minFilter===1007||a.minFilter===1005||a.minFilter===1008)&&K(`WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device.`),e.texParameteri(n,e.TEXTURE_WRAP_S,ae[a.wrapS]),e.texParameteri(n,e.TEXTURE_WRAP_T,ae[a.wrapT]),(n===e.TEXTURE_3D||n===e.TEXTURE_2D_ARRAY)&&e.texParameteri(n,e.TEXTURE_WRAP_R,ae[a.wrapR]),e.texParameteri(n,e.TEXTURE_MAG_FILTER,oe[a.magFilter]),e.texParameteri(n,e.TEXTURE_MIN_FILTER,oe[a.minFilter]),a.compareFunction&&(e.texParameteri(n,e.TEXTURE_COMPARE_MODE,e.COMPARE_REF_TO_TEXTURE),e.texParameteri(n,e.TEXTURE_COMPARE_FUNC,se[a.compareFunction])),t.has(`EXT_texture_filter_anisotropic`)===!0){if(a.magFilter===1003||a.minFilter!==1005&&a.minFilter!==1008||a.type===1015&&t.has(`OES_texture_float_linear`)===!1)return;if(a.anisotropy>1||r.get(a).__currentAnisotropy){let o=t.get(`EXT_texture_filter_anisotropic`);e.texParameterf(n,o.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(a.anisotropy,i.getMaxAnisotropy())),r.get(a).__currentAnisotropy=a.anisotropy}}}function le(t,n){let r=!1;t.__webglInit===void 0&&(t.__webglInit=!0,n.addEventListener(`dispose`,D),T(n));let i=n.source,a=p.get(i);a===void 0&&(a={},p.set(i,a));let s=ie(n);if(s!==t.__cacheKey){a[s]===void 0&&(a[s]={texture:e.createTexture(),usedTimes:0},o.memory.textures++,r=!0),a[s].usedTimes++;let i=a[t.__cacheKey];i!==void 0&&(a[t.__cacheKey].usedTimes--,i.usedTimes===0&&N(n)),t.__cacheKey=s,t.__webglTexture=a[s].texture}return r}function ue(e,t,n){return Math.floor(Math.floor(e/n)/t)}function de(t,r,i,a){let o=t.updateRanges;if(o.length===0)n.texSubImage2D(e.TEXTURE_2D,0,0,0,r.width,r.height,i,a,r.data);else{o.sort((e,t)=>e.start-t.start);let s=0;for(let e=1;e<o.length;e++){let t=o[s],n=o[e],i=t.start+t.count,a=ue(n.start,r.width,4),c=ue(t.start,r.width,4);n.start<=i+1&&a===c&&ue(n.start+n.count-1,r.width,4)===a?t.count=Math.max(t.count,n.start+n.count-t.start):(++s,o[s]=n)}o.length=s+1;let c=n.getParameter(e.UNPACK_ROW_LENGTH),l=n.getParameter(e.UNPACK_SKIP_PIXELS),u=n.getParameter(e.UNPACK_SKIP_ROWS);n.pixelStorei(e.UNPACK_ROW_LENGTH,r.width);for(let t=0,s=o.length;t<s;t++){let s=o[t],c=Math.floor(s.start/4),l=Math.ceil(s.count/4),u=c%r.width,d=Math.floor(c/r.width),f=l;n.pixelStorei(e.UNPACK_SKIP_PIXELS,u),n.pixelStorei(e.UNPACK_SKIP_ROWS,d),n.texSubImage2D(e.TEXTURE_2D,0,u,d,f,1,i,a,r.data)}t.clearUpdateRanges(),n.pixelStorei(e.UNPACK_ROW_LENGTH,c),n.pixelStorei(e.UNPACK_SKIP_PIXELS,l),n.pixelStorei(e.UNPACK_SKIP_ROWS,u)}}function fe(t,o,s){let c=e.TEXTURE_2D;(o.isDataArrayTexture||o.isCompressedArrayTexture)&&(c=e.TEXTURE_2D_ARRAY),o.isData3DTexture&&(c=e.TEXTURE_3D);let l=le(t,o),u=o.source;n.bindTexture(c,t.__webglTexture,e.TEXTURE0+s);let f=r.get(u);if(u.version!==f.__version||l===!0){if(n.activeTexture(e.TEXTURE0+s),!(typeof ImageBitmap<`u`&&o.image instanceof ImageBitmap)){let t=_d.getPrimaries(_d.workingColorSpace),r=o.colorSpace===``?null:_d.getPrimaries(o.colorSpace),i=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,i)}n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment);let t=v(o.image,!1,i.maxTextureSize);t=G(o,t);let r=a.convert(o.format,o.colorSpace),p=a.convert(o.type),m=S(o.internalFormat,r,p,o.normalized,o.colorSpace,o.isVideoTexture);ce(c,o);let h,g=o.mipmaps,_=o.isVideoTexture!==!0,x=f.__version===void 0||l===!0,T=u.dataReady,E=w(o,t);if(o.isDepthTexture)m=C(o.format===xl,o.type),x&&(_?n.texStorage2D(e.TEXTURE_2D,1,m,t.width,t.height):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,null));else if(o.isDataTexture){if(g.length>0){_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data);o.generateMipmaps=!1}else _?(x&&n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height),T&&de(o,t,r,p)):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,t.data)}else if(o.isCompressedTexture){if(o.isCompressedArrayTexture){_&&x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,g[0].width,g[0].height,t.depth);for(let i=0,a=g.length;i<a;i++)if(h=g[i],o.format!==1023){if(r!==null){if(_){if(T){if(o.layerUpdates.size>0){let t=z_(h.width,h.height,o.format,o.type);for(let a of o.layerUpdates){let o=h.data.subarray(a*t/h.data.BYTES_PER_ELEMENT,(a+1)*t/h.data.BYTES_PER_ELEMENT);n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,a,h.width,h.height,1,r,o)}}else n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,h.data)}}else n.compressedTexImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,h.data,0,0)}else K(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`)}else _?T&&n.texSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,p,h.data):n.texImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,r,p,h.data);o.layerUpdates.size>0&&o.clearLayerUpdates()}else{_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],o.format===1023?_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data):r===null?K(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`):_?T&&n.compressedTexSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,h.data):n.compressedTexImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,h.data)}}else if(o.isDataArrayTexture){if(_){if(x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,t.width,t.height,t.depth),T){if(o.layerUpdates.size>0){let i=z_(t.width,t.height,o.format,o.type);for(let a of o.layerUpdates){let o=t.data.subarray(a*i/t.data.BYTES_PER_ELEMENT,(a+1)*i/t.data.BYTES_PER_ELEMENT);n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,a,t.width,t.height,1,r,p,o)}o.clearLayerUpdates()}else n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)}}else n.texImage3D(e.TEXTURE_2D_ARRAY,0,m,t.width,t.height,t.depth,0,r,p,t.data)}else if(o.isData3DTexture)_?(x&&n.texStorage3D(e.TEXTURE_3D,E,m,t.width,t.height,t.depth),T&&n.texSubImage3D(e.TEXTURE_3D,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)):n.texImage3D(e.TEXTURE_3D,0,m,t.width,t.height,t.depth,0,r,p,t.data);else if(o.isFramebufferTexture){if(x){if(_)n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height);else{let i=t.width,a=t.height;for(let t=0;t<E;t++)n.texImage2D(e.TEXTURE_2D,t,m,i,a,0,r,p,null),i>>=1,a>>=1}}}else if(o.isHTMLTexture){if(`texElementImage2D`in e){let n=e.canvas;if(n.hasAttribute(`layoutsubtree`)||n.setAttribute(`layoutsubtree`,`true`),t.parentNode!==n){n.appendChild(t),d.add(o),n.onpaint=e=>{let t=e.changedElements;for(let e of d)t.includes(e.image)&&(e.needsUpdate=!0)},n.requestPaint();return}if(e.texElementImage2D.length===3)e.texElementImage2D(e.TEXTURE_2D,e.RGBA8,t);else{let n=e.RGBA,r=e.RGBA,i=e.UNSIGNED_BYTE;e.texElementImage2D(e.TEXTURE_2D,0,n,r,i,t)}e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,e.LINEAR),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_S,e.CLAMP_TO_EDGE),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_T,e.CLAMP_TO_EDGE)}}else if(g.length>0){if(_&&x){let t=xe(g[0]);n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height)}for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,r,p,h):n.texImage2D(e.TEXTURE_2D,t,m,r,p,h);o.generateMipmaps=!1}else if(_){if(x){let r=xe(t);n.texStorage2D(e.TEXTURE_2D,E,m,r.width,r.height)}T&&n.texSubImage2D(e.TEXTURE_2D,0,0,0,r,p,t)}else n.texImage2D(e.TEXTURE_2D,0,m,r,p,t);y(o)&&o.mipmapsAutoUpdate===!0&&b(c),f.__version=u.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function pe(t,o,s){if(o.image.length!==6)return;let c=le(t,o),l=o.source;n.bindTexture(e.TEXTURE_CUBE_MAP,t.__webglTexture,e.TEXTURE0+s);let u=r.get(l);if(l.version!==u.__version||c===!0){n.activeTexture(e.TEXTURE0+s);let t=_d.getPrimaries(_d.workingColorSpace),r=o.colorSpace===``?null:_d.getPrimaries(o.colorSpace),d=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,d);let f=o.isCompressedTexture||o.image[0].isCompressedTexture,p=o.image[0]&&o.image[0].isDataTexture,m=[];for(let e=0;e<6;e++)!f&&!p?m[e]=v(o.image[e],!0,i.maxCubemapSize):m[e]=p?o.image[e].image:o.image[e],m[e]=G(o,m[e]);let h=m[0],g=a.convert(o.format,o.colorSpace),_=a.convert(o.type),x=S(o.internalFormat,g,_,o.normalized,o.colorSpace),T=o.isVideoTexture!==!0,E=u.__version===void 0||c===!0,D=l.dataReady,O=w(o,h);ce(e.TEXTURE_CUBE_MAP,o);let k;if(o.isDepthTexture){if(x=C(o.format===xl,o.type),E){if(T)n.texStorage2D(e.TEXTURE_CUBE_MAP,1,x,h.width,h.height);else for(let t=0;t<6;t++)n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,h.width,h.height,0,g,_,null)}}else if(f){T&&E&&n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,h.width,h.height);for(let t=0;t<6;t++){k=m[t].mipmaps;for(let r=0;r<k.length;r++){let i=k[r];o.format===1023?T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,g,_,i.data):g===null?K(`WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()`):T?D&&n.compressedTexSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,i.data):n.compressedTexImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,i.data)}}}else{if(k=o.mipmaps,T&&E){k.length>0&&O++;let t=xe(m[0]);n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,t.width,t.height)}for(let t=0;t<6;t++)if(p){T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,m[t].width,m[t].height,g,_,m[t].data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,m[t].width,m[t].height,0,g,_,m[t].data);for(let r=0;r<k.length;r++){let i=k[r].image[t].image;T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,i.width,i.height,0,g,_,i.data)}}else{T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,g,_,m[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,g,_,m[t]);for(let r=0;r<k.length;r++){let i=k[r];T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,g,_,i.image[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,g,_,i.image[t])}}}y(o)&&o.mipmapsAutoUpdate===!0&&b(e.TEXTURE_CUBE_MAP),u.__version=l.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function me(t,i,o,c,l,u){let d=a.convert(o.format,o.colorSpace),f=a.convert(o.type),p=S(o.internalFormat,d,f,o.normalized,o.colorSpace),m=r.get(i),h=r.get(o);if(h.__renderTarget=i,!m.__hasExternalTextures){let t=Math.max(1,i.width>>u),r=Math.max(1,i.height>>u);l===e.TEXTURE_3D||l===e.TEXTURE_2D_ARRAY?n.texImage3D(l,u,p,t,r,i.depth,0,d,f,null):n.texImage2D(l,u,p,t,r,0,d,f,null)}n.bindFramebuffer(e.FRAMEBUFFER,t),be(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,c,l,h.__webglTexture,0,U(i)):(l===e.TEXTURE_2D||l>=e.TEXTURE_CUBE_MAP_POSITIVE_X&&l<=e.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&e.framebufferTexture2D(e.FRAMEBUFFER,c,l,h.__webglTexture,u),n.bindFramebuffer(e.FRAMEBUFFER,null)}function he(t,n,r){if(e.bindRenderbuffer(e.RENDERBUFFER,t),n.depthBuffer){let i=n.depthTexture,a=i&&i.isDepthTexture?i.type:null,o=C(n.stencilBuffer,a),c=n.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;be(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,U(n),o,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,U(n),o,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,o,n.width,n.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,c,e.RENDERBUFFER,t)}else{let t=n.textures;for(let i=0;i<t.length;i++){let o=t[i],c=a.convert(o.format,o.colorSpace),l=a.convert(o.type),u=S(o.internalFormat,c,l,o.normalized,o.colorSpace);be(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,U(n),u,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,U(n),u,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,u,n.width,n.height)}}e.bindRenderbuffer(e.RENDERBUFFER,null)}function ge(t,i,a){let o=i.isWebGLCubeRenderTarget===!0;if(n.bindFramebuffer(e.FRAMEBUFFER,t),!(i.depthTexture&&i.depthTexture.isDepthTexture))throw Error(`THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.`);let c=r.get(i.depthTexture);c.__renderTarget=i;let l=o?i.depthTexture.image[0]:i.depthTexture.image;c.__webglTexture&&l.width===i.width&&l.height===i.height||(l.width=i.width,l.height=i.height,i.depthTexture.needsUpdate=!0),o?z(i.depthTexture,0):I(i.depthTexture,0);let u=c.__webglTexture,d=U(i),f=o?e.TEXTURE_CUBE_MAP_POSITIVE_X+a:e.TEXTURE_2D,p=i.depthTexture.format===1027?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;if(i.depthTexture.format===1026)be(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else if(i.depthTexture.format===1027)be(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else throw Error(`THREE.WebGLTextures: Unknown depthTexture format.`)}function _e(t){let i=r.get(t),a=t.isWebGLCubeRenderTarget===!0;if(i.__boundDepthTexture!==t.depthTexture){let e=t.depthTexture;if(i.__depthDisposeCallback&&i.__depthDisposeCallback(),e){let t=()=>{delete i.__boundDepthTexture,delete i.__depthDisposeCallback,e.removeEventListener(`dispose`,t)};e.addEventListener(`dispose`,t),i.__depthDisposeCallback=t}i.__boundDepthTexture=e}if(t.depthTexture&&!i.__autoAllocateDepthBuffer){if(a)for(let e=0;e<6;e++)ge(i.__webglFramebuffer[e],t,e);else t.texture.mipmaps.length>0?ge(i.__webglFramebuffer[0],t,0):ge(i.__webglFramebuffer,t,0)}else if(a){i.__webglDepthbuffer=[];for(let r=0;r<6;r++)if(n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[r]),i.__webglDepthbuffer[r]===void 0)i.__webglDepthbuffer[r]=e.createRenderbuffer(),he(i.__webglDepthbuffer[r],t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,a=i.__webglDepthbuffer[r];e.bindRenderbuffer(e.RENDERBUFFER,a),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,a)}}else if(t.texture.mipmaps.length>0?n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[0]):n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer),i.__webglDepthbuffer===void 0)i.__webglDepthbuffer=e.createRenderbuffer(),he(i.__webglDepthbuffer,t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,r=i.__webglDepthbuffer;e.bindRenderbuffer(e.RENDERBUFFER,r),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,r)}n.bindFramebuffer(e.FRAMEBUFFER,null)}function ve(t,n,i){let a=r.get(t);n!==void 0&&me(a.__webglFramebuffer,t,t.texture,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,0),i!==void 0&&_e(t)}function B(t){let i=t.texture,s=r.get(t),c=r.get(i);t.addEventListener(`dispose`,O),T(t);let l=t.textures,u=t.isWebGLCubeRenderTarget===!0,d=l.length>1;if(d||(c.__webglTexture===void 0&&(c.__webglTexture=e.createTexture()),c.__version=i.version,o.memory.textures++),u){s.__webglFramebuffer=[];for(let t=0;t<6;t++)if(i.mipmaps.length>0){s.__webglFramebuffer[t]=[];for(let n=0;n<i.mipmaps.length;n++)s.__webglFramebuffer[t][n]=e.createFramebuffer()}else s.__webglFramebuffer[t]=e.createFramebuffer()}else{if(i.mipmaps.length>0){s.__webglFramebuffer=[];for(let t=0;t<i.mipmaps.length;t++)s.__webglFramebuffer[t]=e.createFramebuffer()}else s.__webglFramebuffer=e.createFramebuffer();if(d)for(let t=0,n=l.length;t<n;t++){let n=r.get(l[t]);n.__webglTexture===void 0&&(n.__webglTexture=e.createTexture(),o.memory.textures++)}if(t.samples>0&&be(t)===!1){s.__webglMultisampledFramebuffer=e.createFramebuffer(),s.__webglColorRenderbuffer=[],n.bindFramebuffer(e.FRAMEBUFFER,s.__webglMultisampledFramebuffer);for(let n=0;n<l.length;n++){let r=l[n];s.__webglColorRenderbuffer[n]=e.createRenderbuffer(),e.bindRenderbuffer(e.RENDERBUFFER,s.__webglColorRenderbuffer[n]);let i=a.convert(r.format,r.colorSpace),o=a.convert(r.type),c=S(r.internalFormat,i,o,r.normalized,r.colorSpace,t.isXRRenderTarget===!0),u=U(t);e.renderbufferStorageMultisample(e.RENDERBUFFER,u,c,t.width,t.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+n,e.RENDERBUFFER,s.__webglColorRenderbuffer[n])}e.bindRenderbuffer(e.RENDERBUFFER,null),t.depthBuffer&&(s.__webglDepthRenderbuffer=e.createRenderbuffer(),he(s.__webglDepthRenderbuffer,t,!0)),n.bindFramebuffer(e.FRAMEBUFFER,null)}}if(u){n.bindTexture(e.TEXTURE_CUBE_MAP,c.__webglTexture),ce(e.TEXTURE_CUBE_MAP,i);for(let n=0;n<6;n++)if(i.mipmaps.length>0)for(let r=0;r<i.mipmaps.length;r++)me(s.__webglFramebuffer[n][r],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,r);else me(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,0);y(i)?b(e.TEXTURE_CUBE_MAP):i.mipmaps.length>0&&e.texParameteri(e.TEXTURE_CUBE_MAP,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}else if(d){for(let i=0,a=l.length;i<a;i++){let a=l[i],o=r.get(a),c=e.TEXTURE_2D;(t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(c=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(c,o.__webglTexture),ce(c,a),me(s.__webglFramebuffer,t,a,e.COLOR_ATTACHMENT0+i,c,0),y(a)&&b(c)}n.unbindTexture()}else{let r=e.TEXTURE_2D;if((t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(r=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(r,c.__webglTexture),ce(r,i),i.mipmaps.length>0)for(let n=0;n<i.mipmaps.length;n++)me(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,r,n);else me(s.__webglFramebuffer,t,i,e.COLOR_ATTACHMENT0,r,0);y(i)?b(r):i.mipmaps.length>0&&e.texParameteri(r,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}t.depthBuffer&&_e(t)}function V(e){let t=e.textures;for(let i=0,a=t.length;i<a;i++){let a=t[i];if(y(a)&&a.mipmapsAutoUpdate===!0){let t=x(e),i=r.get(a).__webglTexture;n.bindTexture(t,i),b(t),n.unbindTexture()}}}let H=[];function ye(t){if(t.samples>0){if(be(t)===!1){let i=t.textures,a=t.width,o=t.height,s=e.COLOR_BUFFER_BIT,l=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,u=r.get(t),d=i.length>1;if(d)for(let t=0;t<i.length;t++)n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,null),n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,null,0);n.bindFramebuffer(e.READ_FRAMEBUFFER,u.__webglMultisampledFramebuffer),t.texture.mipmaps.length>0?n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer[0]):n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer);for(let n=0;n<i.length;n++){if(t.resolveDepthBuffer&&(t.depthBuffer&&(s|=e.DEPTH_BUFFER_BIT),t.stencilBuffer&&t.resolveStencilBuffer&&(s|=e.STENCIL_BUFFER_BIT)),d){e.framebufferRenderbuffer(e.READ_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.RENDERBUFFER,u.__webglColorRenderbuffer[n]);let t=r.get(i[n]).__webglTexture;e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,t,0)}e.blitFramebuffer(0,0,a,o,0,0,a,o,s,e.NEAREST),c===!0&&(H.length=0,H.push(e.COLOR_ATTACHMENT0+n),t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&H.push(l),e.invalidateFramebuffer(e.READ_FRAMEBUFFER,H))}if(n.bindFramebuffer(e.READ_FRAMEBUFFER,null),n.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),d)for(let t=0;t<i.length;t++){n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,u.__webglColorRenderbuffer[t]);let a=r.get(i[t]).__webglTexture;n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,a,0)}n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglMultisampledFramebuffer)}else if(t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&c){let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;e.invalidateFramebuffer(e.DRAW_FRAMEBUFFER,[n])}}}function U(e){return Math.min(i.maxSamples,e.samples)}function be(e){let n=r.get(e);return e.samples>0&&t.has(`WEBGL_multisampled_render_to_texture`)===!0&&n.__useRenderToTexture!==!1}function W(e){let t=o.render.frame;u.get(e)!==t&&(u.set(e,t),e.update())}function G(e,t){let n=e.colorSpace,r=e.format,i=e.type;return e.isCompressedTexture===!0||e.isVideoTexture===!0||n!==`srgb-linear`&&n!==``&&(_d.getTransfer(n)===`srgb`?(r!==1023||i!==1009)&&K(`WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType.`):q(`WebGLTextures: Unsupported texture color space:`,n)),t}function xe(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement?(l.width=e.naturalWidth||e.width,l.height=e.naturalHeight||e.height):typeof VideoFrame<`u`&&e instanceof VideoFrame?(l.width=e.displayWidth,l.height=e.displayHeight):(l.width=e.width,l.height=e.height),l}this.allocateTextureUnit=F,this.resetTextureUnits=ne,this.getTextureUnits=re,this.setTextureUnits=P,this.setTexture2D=I,this.setTexture2DArray=L,this.setTexture3D=R,this.setTextureCube=z,this.rebindTextures=ve,this.setupRenderTarget=B,this.updateRenderTargetMipmap=V,this.updateMultisampleRenderTarget=ye,this.setupDepthRenderbuffer=_e,this.setupFrameBufferTexture=me,this.useMultisampledRTT=be,this.dispose=j}function zb(e,t){function n(n,r=``){let i,a=_d.getTransfer(r);if(n===1009)return e.UNSIGNED_BYTE;if(n===1017)return e.UNSIGNED_SHORT_4_4_4_4;if(n===1018)return e.UNSIGNED_SHORT_5_5_5_1;if(n===35902)return e.UNSIGNED_INT_5_9_9_9_REV;if(n===35899)return e.UNSIGNED_INT_10F_11F_11F_REV;if(n===1010)return e.BYTE;if(n===1011)return e.SHORT;if(n===1012)return e.UNSIGNED_SHORT;if(n===1013)return e.INT;if(n===1014)return e.UNSIGNED_INT;if(n===1015)return e.FLOAT;if(n===1016)return e.HALF_FLOAT;if(n===1021)return e.ALPHA;if(n===1022)return e.RGB;if(n===1023)return e.RGBA;if(n===1026)return e.DEPTH_COMPONENT;if(n===1027)return e.DEPTH_STENCIL;if(n===1028)return e.RED;if(n===1029)return e.RED_INTEGER;if(n===1030)return e.RG;if(n===1031)return e.RG_INTEGER;if(n===1033)return e.RGBA_INTEGER;if(n===33776||n===33777||n===33778||n===33779){if(a===`srgb`){if(i=t.get(`WEBGL_compressed_texture_s3tc_srgb`),i!==null){if(n===33776)return i.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null}else if(i=t.get(`WEBGL_compressed_texture_s3tc`),i!==null){if(n===33776)return i.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null}if(n===35840||n===35841||n===35842||n===35843){if(i=t.get(`WEBGL_compressed_texture_pvrtc`),i!==null){if(n===35840)return i.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===35841)return i.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===35842)return i.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===35843)return i.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null}if(n===36196||n===37492||n===37496||n===37488||n===37489||n===37490||n===37491){if(i=t.get(`WEBGL_compressed_texture_etc`),i!==null){if(n===36196||n===37492)return a===`srgb`?i.COMPRESSED_SRGB8_ETC2:i.COMPRESSED_RGB8_ETC2;if(n===37496)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:i.COMPRESSED_RGBA8_ETC2_EAC;if(n===37488)return i.COMPRESSED_R11_EAC;if(n===37489)return i.COMPRESSED_SIGNED_R11_EAC;if(n===37490)return i.COMPRESSED_RG11_EAC;if(n===37491)return i.COMPRESSED_SIGNED_RG11_EAC}else return null}if(n===37808||n===37809||n===37810||n===37811||n===37812||n===37813||n===37814||n===37815||n===37816||n===37817||n===37818||n===37819||n===37820||n===37821){if(i=t.get(`WEBGL_compressed_texture_astc`),i!==null){if(n===37808)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:i.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===37809)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:i.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===37810)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:i.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===37811)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:i.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===37812)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:i.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===37813)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:i.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===37814)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:i.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===37815)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:i.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===37816)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:i.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===37817)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:i.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===37818)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:i.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===37819)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:i.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===37820)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:i.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===37821)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:i.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null}if(n===36492||n===36494||n===36495){if(i=t.get(`EXT_texture_compression_bptc`),i!==null){if(n===36492)return a===`srgb`?i.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:i.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===36494)return i.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===36495)return i.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null}if(n===36283||n===36284||n===36285||n===36286){if(i=t.get(`EXT_texture_compression_rgtc`),i!==null){if(n===36283)return i.COMPRESSED_RED_RGTC1_EXT;if(n===36284)return i.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===36285)return i.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===36286)return i.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null}return n===1020?e.UNSIGNED_INT_24_8:e[n]===void 0?null:e[n]}return{convert:n}}var Bb=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,Vb=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,Hb=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new bm(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new fg({vertexShader:Bb,fragmentShader:Vb,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Lp(new Yh(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Ub=class extends Fu{constructor(e,t){super();let n=this,r=null,i=1,a=null,o=`local-floor`,s=1,c=null,l=null,u=null,d=null,f=null,p=null,m=typeof XRWebGLBinding<`u`,h=new Hb,g={},_=t.getContextAttributes(),v=null,y=null,b=[],x=[],S=new Y,C=null,w=null,T=new r_;T.viewport=new Od;let E=new r_;E.viewport=new Od;let D=[T,E],O=new d_,k=null,A=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(e){let t=b[e];return t===void 0&&(t=new uf,b[e]=t),t.getTargetRaySpace()},this.getControllerGrip=function(e){let t=b[e];return t===void 0&&(t=new uf,b[e]=t),t.getGripSpace()},this.getHand=function(e){let t=b[e];return t===void 0&&(t=new uf,b[e]=t),t.getHandSpace()};function j(e){let t=x.indexOf(e.inputSource);if(t===-1)return;let n=b[t];n!==void 0&&(n.update(e.inputSource,e.frame,c||a),n.dispatchEvent({type:e.type,data:e.inputSource}))}function M(){r.removeEventListener(`select`,j),r.removeEventListener(`selectstart`,j),r.removeEventListener(`selectend`,j),r.removeEventListener(`squeeze`,j),r.removeEventListener(`squeezestart`,j),r.removeEventListener(`squeezeend`,j),r.removeEventListener(`end`,M),r.removeEventListener(`inputsourceschange`,N);for(let e=0;e<b.length;e++){let t=x[e];t!==null&&(x[e]=null,b[e].disconnect(t))}k=null,A=null,h.reset();for(let e in g)delete g[e];if(e.setRenderTarget(v),f=null,d=null,u=null,r=null,y=null,P.stop(),n.isPresenting=!1,e.setPixelRatio(C),e.setSize(S.width,S.height,!1),w!==null){let e=w.camera;e.fov=w.fov,e.zoom=w.zoom,e.updateProjectionMatrix(),w=null}n.dispatchEvent({type:`sessionend`})}this.setFramebufferScaleFactor=function(e){i=e,n.isPresenting===!0&&K(`WebXRManager: Cannot change framebuffer scale while presenting.`)},this.setReferenceSpaceType=function(e){o=e,n.isPresenting===!0&&K(`WebXRManager: Cannot change reference space type while presenting.`)},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(e){c=e},this.getBaseLayer=function(){return d===null?f:d},this.getBinding=function(){return u===null&&m&&(u=new XRWebGLBinding(r,t)),u},this.getFrame=function(){return p},this.getSession=function(){return r},this.setSession=async function(l){if(r=l,r!==null){if(v=e.getRenderTarget(),r.addEventListener(`select`,j),r.addEventListener(`selectstart`,j),r.addEventListener(`selectend`,j),r.addEventListener(`squeeze`,j),r.addEventListener(`squeezestart`,j),r.addEventListener(`squeezeend`,j),r.addEventListener(`end`,M),r.addEventListener(`inputsourceschange`,N),_.xrCompatible!==!0&&await t.makeXRCompatible(),C=e.getPixelRatio(),e.getSize(S),m&&`createProjectionLayer`in XRWebGLBinding.prototype){let n=null,a=null,o=null;_.depth&&(o=_.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,n=_.stencil?xl:bl,a=_.stencil?ml:ll);let s={colorFormat:t.RGBA8,depthFormat:o,scaleFactor:i};u=this.getBinding(),d=u.createProjectionLayer(s),r.updateRenderState({layers:[d]}),e.setPixelRatio(1),e.setSize(d.textureWidth,d.textureHeight,!1),y=new Ad(d.textureWidth,d.textureHeight,{format:yl,type:il,depthTexture:new vm(d.textureWidth,d.textureHeight,a,void 0,void 0,void 0,void 0,void 0,void 0,n),stencilBuffer:_.stencil,colorSpace:e.outputColorSpace,samples:_.antialias?4:0,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}else{let n={antialias:_.antialias,alpha:!0,depth:_.depth,stencil:_.stencil,framebufferScaleFactor:i};f=new XRWebGLLayer(r,t,n),r.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),y=new Ad(f.framebufferWidth,f.framebufferHeight,{format:yl,type:il,colorSpace:e.outputColorSpace,stencilBuffer:_.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}y.isXRRenderTarget=!0,this.setFoveation(s),c=null,a=await r.requestReferenceSpace(o),P.setContext(r),P.start(),n.isPresenting=!0,n.dispatchEvent({type:`sessionstart`})}},this.getEnvironmentBlendMode=function(){if(r!==null)return r.environmentBlendMode},this.getDepthTexture=function(){return h.getDepthTexture()};function N(e){for(let t=0;t<e.removed.length;t++){let n=e.removed[t],r=x.indexOf(n);r>=0&&(x[r]=null,b[r].disconnect(n))}for(let t=0;t<e.added.length;t++){let n=e.added[t],r=x.indexOf(n);if(r===-1){for(let e=0;e<b.length;e++)if(e>=x.length){x.push(n),r=e;break}else if(x[e]===null){x[e]=n,r=e;break}if(r===-1)break}let i=b[r];i&&i.connect(n)}}function ee(e,t){t===null?e.matrixWorld.copy(e.matrix):e.matrixWorld.multiplyMatrices(t.matrixWorld,e.matrix),e.matrixWorldInverse.copy(e.matrixWorld).invert()}this.updateCamera=function(e){if(r===null)return;let t=e.near,n=e.far;h.texture!==null&&(h.depthNear>0&&(t=h.depthNear),h.depthFar>0&&(n=h.depthFar)),O.near=E.near=T.near=t,O.far=E.far=T.far=n,(k!==O.near||A!==O.far)&&(r.updateRenderState({depthNear:O.near,depthFar:O.far}),k=O.near,A=O.far),O.layers.mask=e.layers.mask|6,T.layers.mask=O.layers.mask&-5,E.layers.mask=O.layers.mask&-3;let i=e.parent,a=O.cameras;ee(O,i);for(let e=0;e<a.length;e++)ee(a[e],i);O.projectionMatrix.copy(T.projectionMatrix),O.projectionMatrixInverse.copy(T.projectionMatrixInverse),w===null&&e.isPerspectiveCamera&&(w={camera:e,fov:e.fov,zoom:e.zoom}),te(e,O,i)};function te(e,t,n){n===null?e.matrix.copy(t.matrixWorld):(e.matrix.copy(n.matrixWorld),e.matrix.invert(),e.matrix.multiply(t.matrixWorld)),e.matrix.decompose(e.position,e.quaternion,e.scale),e.updateMatrixWorld(!0),e.projectionMatrix.copy(t.projectionMatrix),e.projectionMatrixInverse.copy(t.projectionMatrixInverse),e.isPerspectiveCamera&&(e.fov=zu*2*Math.atan(1/e.projectionMatrix.elements[5]),e.zoom=1)}this.getCamera=function(){return O},this.getFoveation=function(){if(d!==null||f!==null)return s},this.setFoveation=function(e){s=e,d!==null&&(d.fixedFoveation=e),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=e)},this.hasDepthSensing=function(){return h.texture!==null},this.getDepthSensingMesh=function(){return h.getMesh(O)},this.getCameraTexture=function(e){return g[e]};let ne=null;function re(t,i){if(l=i.getViewerPose(c||a),p=i,l!==null){let t=l.views;f!==null&&(e.setRenderTargetFramebuffer(y,f.framebuffer),e.setRenderTarget(y));let i=!1;t.length!==O.cameras.length&&(O.cameras.length=0,i=!0);for(let n=0;n<t.length;n++){let r=t[n],a=null;if(f!==null)a=f.getViewport(r);else{let t=u.getViewSubImage(d,r);a=t.viewport,n===0&&(e.setRenderTargetTextures(y,t.colorTexture,t.depthStencilTexture),e.setRenderTarget(y))}let o=D[n];o===void 0&&(o=new r_,o.layers.enable(n),o.viewport=new Od,D[n]=o),o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.projectionMatrix.fromArray(r.projectionMatrix),o.projectionMatrixInverse.copy(o.projectionMatrix).invert(),o.viewport.set(a.x,a.y,a.width,a.height),n===0&&(O.matrix.copy(o.matrix),O.matrix.decompose(O.position,O.quaternion,O.scale)),i===!0&&O.cameras.push(o)}let a=r.enabledFeatures;if(a&&a.includes(`depth-sensing`)&&r.depthUsage==`gpu-optimized`&&m){u=n.getBinding();let e=u.getDepthInformation(t[0]);e&&e.isValid&&e.texture&&h.init(e,r.renderState)}if(a&&a.includes(`camera-access`)&&m){e.state.unbindTexture(),u=n.getBinding();for(let e=0;e<t.length;e++){let n=t[e].camera;if(n){let e=g[n];e||(e=new bm,g[n]=e);let t=u.getCameraImage(n);e.sourceTexture=t}}}}for(let e=0;e<b.length;e++){let t=x[e],n=b[e];t!==null&&n!==void 0&&n.update(t,i,c||a)}ne&&ne(t,i),i.detectedPlanes&&n.dispatchEvent({type:`planesdetected`,data:i}),p=null}let P=new V_;P.setAnimationLoop(re),this.setAnimationLoop=function(e){ne=e},this.dispose=function(){}}},Wb=new Nd,Gb=new fd;Gb.set(-1,0,0,0,1,0,0,0,1);function Kb(e,t){function n(e,t){e.matrixAutoUpdate===!0&&e.updateMatrix(),t.value.copy(e.matrix)}function r(t,n){n.color.getRGB(t.fogColor.value,cg(e)),n.isFog?(t.fogNear.value=n.near,t.fogFar.value=n.far):n.isFogExp2&&(t.fogDensity.value=n.density)}function i(e,t,n,r,i){t.isNodeMaterial?t.uniformsNeedUpdate=!1:t.isMeshBasicMaterial?a(e,t):t.isMeshLambertMaterial?(a(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshToonMaterial?(a(e,t),d(e,t)):t.isMeshPhongMaterial?(a(e,t),u(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshStandardMaterial?(a(e,t),f(e,t),t.isMeshPhysicalMaterial&&p(e,t,i)):t.isMeshMatcapMaterial?(a(e,t),m(e,t)):t.isMeshDepthMaterial?a(e,t):t.isMeshDistanceMaterial?(a(e,t),h(e,t)):t.isMeshNormalMaterial?a(e,t):t.isLineBasicMaterial?(o(e,t),t.isLineDashedMaterial&&s(e,t)):t.isPointsMaterial?c(e,t,n,r):t.isSpriteMaterial?l(e,t):t.isShadowMaterial?(e.color.value.copy(t.color),e.opacity.value=t.opacity):t.isShaderMaterial&&(t.uniformsNeedUpdate=!1)}function a(e,r){e.opacity.value=r.opacity,r.color&&e.diffuse.value.copy(r.color),r.emissive&&e.emissive.value.copy(r.emissive).multiplyScalar(r.emissiveIntensity),r.map&&(e.map.value=r.map,n(r.map,e.mapTransform)),r.alphaMap&&(e.alphaMap.value=r.alphaMap,n(r.alphaMap,e.alphaMapTransform)),r.bumpMap&&(e.bumpMap.value=r.bumpMap,n(r.bumpMap,e.bumpMapTransform),e.bumpScale.value=r.bumpScale,r.side===1&&(e.bumpScale.value*=-1)),r.normalMap&&(e.normalMap.value=r.normalMap,n(r.normalMap,e.normalMapTransform),e.normalScale.value.copy(r.normalScale),r.side===1&&e.normalScale.value.negate()),r.displacementMap&&(e.displacementMap.value=r.displacementMap,n(r.displacementMap,e.displacementMapTransform),e.displacementScale.value=r.displacementScale,e.displacementBias.value=r.displacementBias),r.emissiveMap&&(e.emissiveMap.value=r.emissiveMap,n(r.emissiveMap,e.emissiveMapTransform)),r.specularMap&&(e.specularMap.value=r.specularMap,n(r.specularMap,e.specularMapTransform)),r.alphaTest>0&&(e.alphaTest.value=r.alphaTest);let i=t.get(r),a=i.envMap,o=i.envMapRotation;a&&(e.envMap.value=a,e.envMapRotation.value.setFromMatrix4(Wb.makeRotationFromEuler(o)).transpose(),a.isCubeTexture&&a.isRenderTargetTexture===!1&&e.envMapRotation.value.premultiply(Gb),e.reflectivity.value=r.reflectivity,e.ior.value=r.ior,e.refractionRatio.value=r.refractionRatio),r.lightMap&&(e.lightMap.value=r.lightMap,e.lightMapIntensity.value=r.lightMapIntensity,n(r.lightMap,e.lightMapTransform)),r.aoMap&&(e.aoMap.value=r.aoMap,e.aoMapIntensity.value=r.aoMapIntensity,n(r.aoMap,e.aoMapTransform))}function o(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform))}function s(e,t){e.dashSize.value=t.dashSize,e.totalSize.value=t.dashSize+t.gapSize,e.scale.value=t.scale}function c(e,t,r,i){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.size.value=t.size*r,e.scale.value=i*.5,t.map&&(e.map.value=t.map,n(t.map,e.uvTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function l(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.rotation.value=t.rotation,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function u(e,t){e.specular.value.copy(t.specular),e.shininess.value=Math.max(t.shininess,1e-4)}function d(e,t){t.gradientMap&&(e.gradientMap.value=t.gradientMap)}function f(e,t){e.metalness.value=t.metalness,t.metalnessMap&&(e.metalnessMap.value=t.metalnessMap,n(t.metalnessMap,e.metalnessMapTransform)),e.roughness.value=t.roughness,t.roughnessMap&&(e.roughnessMap.value=t.roughnessMap,n(t.roughnessMap,e.roughnessMapTransform)),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)}function p(e,t,r){e.ior.value=t.ior,t.diffuseRoughness>0&&(e.diffuseRoughness.value=t.diffuseRoughness,t.diffuseRoughnessMap&&(e.diffuseRoughnessMap.value=t.diffuseRoughnessMap,n(t.diffuseRoughnessMap,e.diffuseRoughnessMapTransform))),t.sheen>0&&(e.sheenColor.value.copy(t.sheenColor).multiplyScalar(t.sheen),e.sheenRoughness.value=t.sheenRoughness,t.sheenColorMap&&(e.sheenColorMap.value=t.sheenColorMap,n(t.sheenColorMap,e.sheenColorMapTransform)),t.sheenRoughnessMap&&(e.sheenRoughnessMap.value=t.sheenRoughnessMap,n(t.sheenRoughnessMap,e.sheenRoughnessMapTransform))),t.clearcoat>0&&(e.clearcoat.value=t.clearcoat,e.clearcoatRoughness.value=t.clearcoatRoughness,t.clearcoatMap&&(e.clearcoatMap.value=t.clearcoatMap,n(t.clearcoatMap,e.clearcoatMapTransform)),t.clearcoatRoughnessMap&&(e.clearcoatRoughnessMap.value=t.clearcoatRoughnessMap,n(t.clearcoatRoughnessMap,e.clearcoatRoughnessMapTransform)),t.clearcoatNormalMap&&(e.clearcoatNormalMap.value=t.clearcoatNormalMap,n(t.clearcoatNormalMap,e.clearcoatNormalMapTransform),e.clearcoatNormalScale.value.copy(t.clearcoatNormalScale),t.side===1&&e.clearcoatNormalScale.value.negate())),t.dispersion>0&&(e.dispersion.value=t.dispersion),t.retroreflectivity>0&&(e.retroreflectivity.value=t.retroreflectivity),t.iridescence>0&&(e.iridescence.value=t.iridescence,e.iridescenceIOR.value=t.iridescenceIOR,e.iridescenceThicknessMinimum.value=t.iridescenceThicknessMinimum,e.iridescenceThicknessMaximum.value=t.iridescenceThicknessMaximum,t.iridescenceMap&&(e.iridescenceMap.value=t.iridescenceMap,n(t.iridescenceMap,e.iridescenceMapTransform)),t.iridescenceThicknessMap&&(e.iridescenceThicknessMap.value=t.iridescenceThicknessMap,n(t.iridescenceThicknessMap,e.iridescenceThicknessMapTransform))),t.transmission>0&&(e.transmission.value=t.transmission,e.transmissionSamplerMap.value=r.texture,e.transmissionSamplerSize.value.set(r.width,r.height),t.transmissionMap&&(e.transmissionMap.value=t.transmissionMap,n(t.transmissionMap,e.transmissionMapTransform)),e.thickness.value=t.thickness,t.thicknessMap&&(e.thicknessMap.value=t.thicknessMap,n(t.thicknessMap,e.thicknessMapTransform)),e.attenuationDistance.value=t.attenuationDistance,e.attenuationColor.value.copy(t.attenuationColor)),t.anisotropy>0&&(e.anisotropyVector.value.set(t.anisotropy*Math.cos(t.anisotropyRotation),t.anisotropy*Math.sin(t.anisotropyRotation)),t.anisotropyMap&&(e.anisotropyMap.value=t.anisotropyMap,n(t.anisotropyMap,e.anisotropyMapTransform))),e.specularIntensity.value=t.specularIntensity,e.specularColor.value.copy(t.specularColor),t.specularColorMap&&(e.specularColorMap.value=t.specularColorMap,n(t.specularColorMap,e.specularColorMapTransform)),t.specularIntensityMap&&(e.specularIntensityMap.value=t.specularIntensityMap,n(t.specularIntensityMap,e.specularIntensityMapTransform))}function m(e,t){t.matcap&&(e.matcap.value=t.matcap)}function h(e,n){let r=t.get(n).light;e.referencePosition.value.setFromMatrixPosition(r.matrixWorld),e.nearDistance.value=r.shadow.camera.near,e.farDistance.value=r.shadow.camera.far}return{refreshFogUniforms:r,refreshMaterialUniforms:i}}function qb(e,t,n,r){let i={},a={};function o(e,t){let n=t.program;r.uniformBlockBinding(e,n,i[e.id])}function s(e,n){let o=i[e.id];o===void 0&&(m(e),o=c(e),i[e.id]=o,e.addEventListener(`dispose`,g));let s=n.program;r.updateUBOMapping(e,s);let u=t.render.frame;a[e.id]!==u&&(l(e),a[e.id]=u)}function c(t){let n=e.createBuffer(),r=t.__size,i=t.usage;return e.bindBuffer(e.UNIFORM_BUFFER,n),e.bufferData(e.UNIFORM_BUFFER,r,i),e.bindBuffer(e.UNIFORM_BUFFER,null),n}function l(t){let n=i[t.id],r=t.uniforms,a=t.__cache;e.bindBuffer(e.UNIFORM_BUFFER,n);for(let e=0,t=r.length;e<t;e++){let t=r[e];if(Array.isArray(t))for(let n=0,r=t.length;n<r;n++)u(t[n],e,n,a);else u(t,e,0,a)}e.bindBuffer(e.UNIFORM_BUFFER,null)}function u(t,n,r,i){if(f(t,n,r,i)===!0){let n=t.__offset,r=t.value;if(Array.isArray(r)){let e=0;for(let n=0;n<r.length;n++){let i=r[n],a=h(i,!0);d(i,t.__data,e),e+=a.storage/Float32Array.BYTES_PER_ELEMENT}}else d(r,t.__data,0);e.bufferSubData(e.UNIFORM_BUFFER,n,t.__data)}}function d(e,t,n){typeof e==`number`||typeof e==`boolean`?t[n]=e:e.isMatrix3?(t[n]=e.elements[0],t[n+1]=e.elements[1],t[n+2]=e.elements[2],t[n+3]=0,t[n+4]=e.elements[3],t[n+5]=e.elements[4],t[n+6]=e.elements[5],t[n+7]=0,t[n+8]=e.elements[6],t[n+9]=e.elements[7],t[n+10]=e.elements[8],t[n+11]=0):ArrayBuffer.isView(e)?t.set(e.subarray(0,t.length-n),n):e.toArray(t,n)}function f(e,t,n,r){let i=e.value,a=t+`_`+n;if(Array.isArray(i)){r[a]===void 0&&(r[a]=[]);let e=r[a],t=!1;for(let n=0;n<i.length;n++)p(i[n],e,n)===!0&&(t=!0);return t}return p(i,r,a)}function p(e,t,n){if(t[n]===void 0)return t[n]=typeof e==`number`||typeof e==`boolean`?e:ArrayBuffer.isView(e)?e.slice():e.clone(),!0;{let r=t[n];if(typeof e==`number`||typeof e==`boolean`){if(r!==e)return t[n]=e,!0}else if(ArrayBuffer.isView(e))return!0;else if(r.equals(e)===!1)return r.copy(e),!0}return!1}function m(e){let t=e.uniforms,n=0;for(let e=0,r=t.length;e<r;e++){let r=Array.isArray(t[e])?t[e]:[t[e]];for(let i=0,a=r.length;i<a;i++){let a=r[i],o=Array.isArray(a.value)?a.value:[a.value],s=Array.isArray(t[e])||Array.isArray(a.value),c=n;for(let e=0,t=o.length;e<t;e++){let t=o[e],r=h(t,s),i=n%16,a=i%r.boundary,l=i+a;n+=a,l!==0&&16-l<r.storage&&(n+=16-l),e===0&&(c=n),n+=r.storage}a.__data=new(a.type===`int`?Int32Array:a.type===`uint`?Uint32Array:Float32Array)((n-c)/Float32Array.BYTES_PER_ELEMENT),a.__offset=c}}let r=n%16;return r>0&&(n+=16-r),e.__size=n,e.__cache={},this}function h(e,t){let n={boundary:0,storage:0};return typeof e==`number`||typeof e==`boolean`?(n.boundary=4,n.storage=4):e.isVector2?(n.boundary=8,n.storage=8):e.isVector3||e.isColor?(n.boundary=16,n.storage=12):e.isVector4?(n.boundary=16,n.storage=16):e.isMatrix3?(n.boundary=16,n.storage=48):e.isMatrix4?(n.boundary=16,n.storage=64):e.isTexture?K(`WebGLRenderer: Texture samplers can not be part of an uniforms group.`):ArrayBuffer.isView(e)?(n.boundary=16,n.storage=e.byteLength):K(`WebGLRenderer: Unsupported uniform value type.`,e),t===!0&&(n.boundary=16,n.storage=Math.ceil(n.storage/16)*16),n}function g(t){let n=t.target;n.removeEventListener(`dispose`,g),e.deleteBuffer(i[n.id]),delete i[n.id],delete a[n.id]}function _(){for(let t in i)e.deleteBuffer(i[t]);i={},a={}}return{bind:o,update:s,dispose:_}}var Jb=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),Yb=null;function Xb(){return Yb===null&&(Yb=new Bp(Jb,16,16,wl,dl),Yb.name=`DFG_LUT`,Yb.minFilter=tl,Yb.magFilter=tl,Yb.wrapS=Xc,Yb.wrapT=Xc,Yb.generateMipmaps=!1,Yb.needsUpdate=!0),Yb}var Zb=class{constructor(e={}){let{canvas:t=Ou(),context:n=null,depth:r=!0,stencil:i=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:s=!0,preserveDrawingBuffer:c=!1,powerPreference:l=`default`,failIfMajorPerformanceCaveat:u=!1,reversedDepthBuffer:d=!1,outputBufferType:f=il}=e;this.isWebGLRenderer=!0;let p;if(n!==null){if(typeof WebGLRenderingContext<`u`&&n instanceof WebGLRenderingContext)throw Error(`THREE.WebGLRenderer: WebGL 1 is not supported since r163.`);p=n.getContextAttributes().alpha}else p=a;let m=f,h=new Set([El,Tl,Cl]),g=new Set([il,ll,sl,ml,fl,pl]),_=new Uint32Array(4),v=new Int32Array(4),y={textures:[],min:[],max:[],resolution:[]},b=null,x=null,S=[],C=[],w=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=0,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let T=this,E=!1,D=null,O=null,k=null,A=null;this._outputColorSpace=vu;let j=0,M=0,N=null,ee=-1,te=null,ne=new Od,re=new Od,P=null,F=new Z(0),ie=0,I=t.width,L=t.height,R=1,z=null,ae=null,oe=new Od(0,0,I,L),se=new Od(0,0,I,L),ce=!1,le=new $p,ue=new tm,de=!1,fe=!1,pe=new Nd,me=new X,he=new Od,ge={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},_e=!1;function ve(){return N===null?R:1}let B=n;function V(e,n){return t.getContext(e,n)}let H,ye,U,be,W,G,xe,Se,Ce,we,Te,Ee,De,Oe,ke,Ae,je,Me,Ne,Pe,Fe,Ie,Le;try{let e={alpha:!0,depth:r,stencil:i,antialias:o,premultipliedAlpha:s,preserveDrawingBuffer:c,powerPreference:l,failIfMajorPerformanceCaveat:u};if(`setAttribute`in t&&t.setAttribute(`data-engine`,`three.js r187`),t.addEventListener(`webglcontextlost`,Be,!1),t.addEventListener(`webglcontextrestored`,Ve,!1),t.addEventListener(`webglcontextcreationerror`,He,!1),B===null){let t=`webgl2`;if(B=V(t,e),B===null)throw V(t)?Error(`THREE.WebGLRenderer: Error creating WebGL context with your selected attributes.`):Error(`THREE.WebGLRenderer: Error creating WebGL context.`)}Re()}catch(e){throw t.removeEventListener(`webglcontextlost`,Be,!1),t.removeEventListener(`webglcontextrestored`,Ve,!1),t.removeEventListener(`webglcontextcreationerror`,He,!1),q(`WebGLRenderer: `+e.message),e}function Re(){H=new _v(B),H.init(),Fe=new zb(B,H),ye=new Z_(B,H,e,Fe),U=new Lb(B,H),ye.reversedDepthBuffer&&d&&U.buffers.depth.setReversed(!0),O=B.createFramebuffer(),k=B.createFramebuffer(),A=B.createFramebuffer(),be=new bv(B),W=new _b,G=new Rb(B,H,U,W,ye,Fe,be),xe=new gv(T),Se=new H_(B),Ie=new Y_(B,Se),Ce=new vv(B,Se,be,Ie),we=new Sv(B,Ce,Se,Ie,be),Me=new xv(B,ye,G),ke=new Q_(W),Te=new gb(T,xe,H,ye,Ie,ke),Ee=new Kb(T,W),De=new xb,Oe=new Ob(H),je=new J_(T,xe,U,we,p,s),Ae=new Ib(T,we,ye),Le=new qb(B,be,ye,U),Ne=new X_(B,H,be),Pe=new yv(B,H,be),be.programs=Te.programs,T.capabilities=ye,T.extensions=H,T.properties=W,T.renderLists=De,T.shadowMap=Ae,T.state=U,T.info=be}m!==1009&&(w=new wv(m,t.width,t.height,o,r,i));let ze=new Ub(T,B);this.xr=ze,this.getContext=function(){return B},this.getContextAttributes=function(){return B.getContextAttributes()},this.forceContextLoss=function(){let e=H.get(`WEBGL_lose_context`);e&&e.loseContext()},this.forceContextRestore=function(){let e=H.get(`WEBGL_lose_context`);e&&e.restoreContext()},this.getPixelRatio=function(){return R},this.setPixelRatio=function(e){e!==void 0&&(R=e,this.setSize(I,L,!1))},this.getSize=function(e){return e.set(I,L)},this.setSize=function(e,n,r=!0){ze.isPresenting?K(`WebGLRenderer: Can't change size while VR device is presenting.`):(I=e,L=n,t.width=Math.floor(e*R),t.height=Math.floor(n*R),r===!0&&(t.style.width=e+`px`,t.style.height=n+`px`),w!==null&&w.setSize(t.width,t.height),this.setViewport(0,0,e,n))},this.getDrawingBufferSize=function(e){return e.set(I*R,L*R).floor()},this.setDrawingBufferSize=function(e,n,r){I=e,L=n,R=r,t.width=Math.floor(e*r),t.height=Math.floor(n*r),this.setViewport(0,0,e,n)},this.setEffects=function(e){if(m===1009)q(`WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.`);else{if(e){for(let t=0;t<e.length;t++)if(e[t].isOutputPass===!0){K(`WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.`);break}}w.setEffects(e||[])}},this.getCurrentViewport=function(e){return e.copy(ne)},this.getViewport=function(e){return e.copy(oe)},this.setViewport=function(e,t,n,r){e.isVector4?oe.set(e.x,e.y,e.z,e.w):oe.set(e,t,n,r),U.viewport(ne.copy(oe).multiplyScalar(ve()).round())},this.getScissor=function(e){return e.copy(se)},this.setScissor=function(e,t,n,r){e.isVector4?se.set(e.x,e.y,e.z,e.w):se.set(e,t,n,r),U.scissor(re.copy(se).multiplyScalar(ve()).round())},this.getScissorTest=function(){return ce},this.setScissorTest=function(e){U.setScissorTest(ce=e)},this.setOpaqueSort=function(e){z=e},this.setTransparentSort=function(e){ae=e},this.getClearColor=function(e){return e.copy(je.getClearColor())},this.setClearColor=function(){je.setClearColor(...arguments)},this.getClearAlpha=function(){return je.getClearAlpha()},this.setClearAlpha=function(){je.setClearAlpha(...arguments)},this.clear=function(e=!0,t=!0,n=!0){let r=0;if(e){let e=!1;if(N!==null){let t=N.texture.format;e=h.has(t)}if(e){let e=N.texture.type,t=g.has(e),n=je.getClearColor(),r=je.getClearAlpha(),i=n.r,a=n.g,o=n.b;t?(_[0]=i,_[1]=a,_[2]=o,_[3]=r,B.clearBufferuiv(B.COLOR,0,_)):(v[0]=i,v[1]=a,v[2]=o,v[3]=r,B.clearBufferiv(B.COLOR,0,v))}else r|=B.COLOR_BUFFER_BIT}t&&(r|=B.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),n&&(r|=B.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),r!==0&&B.clear(r)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(e){e.setRenderer(this),D=e},this.dispose=function(){t.removeEventListener(`webglcontextlost`,Be,!1),t.removeEventListener(`webglcontextrestored`,Ve,!1),t.removeEventListener(`webglcontextcreationerror`,He,!1),je.dispose(),De.dispose(),Oe.dispose(),G.dispose(),W.dispose(),xe.dispose(),we.dispose(),Ce.dispose(),Ie.dispose(),Le.dispose(),Te.dispose(),ze.dispose(),ze.removeEventListener(`sessionstart`,Ye),ze.removeEventListener(`sessionend`,Xe),Ze.stop()};function Be(e){e.preventDefault(),Au(`WebGLRenderer: Context Lost.`),E=!0}function Ve(){Au(`WebGLRenderer: Context Restored.`),E=!1;let e=be.autoReset,t=Ae.enabled,n=Ae.autoUpdate,r=Ae.needsUpdate,i=Ae.type;Re(),be.autoReset=e,Ae.enabled=t,Ae.autoUpdate=n,Ae.needsUpdate=r,Ae.type=i}function He(e){q(`WebGLRenderer: A WebGL context could not be created. Reason: `,e.statusMessage)}function Ue(e){let t=e.target;t.removeEventListener(`dispose`,Ue),We(t)}function We(e){Ge(e),W.remove(e)}function Ge(e){let t=W.get(e).programs;t!==void 0&&(t.forEach(function(e){Te.releaseProgram(e)}),e.isShaderMaterial&&Te.releaseShaderCache(e))}this.renderBufferDirect=function(e,t,n,r,i,a){t===null&&(t=ge);let o=i.isMesh&&i.matrixWorld.determinantAffine()<0,s=ct(e,t,n,r,i);U.setMaterial(r,o);let c=n.index,l=1;if(r.wireframe===!0){if(c=Ce.getWireframeAttribute(n),c===void 0)return;l=2}let u=n.drawRange,d=n.attributes.position,f=u.start*l,p=(u.start+u.count)*l;a!==null&&(f=Math.max(f,a.start*l),p=Math.min(p,(a.start+a.count)*l)),c===null?d!=null&&(f=Math.max(f,0),p=Math.min(p,d.count)):(f=Math.max(f,0),p=Math.min(p,c.count));let m=p-f;if(m<0||m===1/0)return;Ie.setup(i,r,s,n,c);let h,g=Ne;if(c!==null&&(h=Se.get(c),g=Pe,g.setIndex(h)),i.isMesh)r.wireframe===!0?(U.setLineWidth(r.wireframeLinewidth*ve()),g.setMode(B.LINES)):g.setMode(B.TRIANGLES);else if(i.isLine){let e=r.linewidth;e===void 0&&(e=1),U.setLineWidth(e*ve()),i.isLineSegments?g.setMode(B.LINES):i.isLineLoop?g.setMode(B.LINE_LOOP):g.setMode(B.LINE_STRIP)}else i.isPoints?g.setMode(B.POINTS):i.isSprite&&g.setMode(B.TRIANGLES);if(i.isBatchedMesh){if(H.get(`WEBGL_multi_draw`))g.renderMultiDraw(i._multiDrawStarts,i._multiDrawCounts,i._multiDrawCount);else{let e=i._multiDrawStarts,t=i._multiDrawCounts,n=i._multiDrawCount,a=c?Se.get(c).bytesPerElement:1,o=W.get(r).currentProgram.getUniforms();for(let r=0;r<n;r++)o.setValue(B,`_gl_DrawID`,r),g.render(e[r]/a,t[r])}}else if(i.isInstancedMesh)g.renderInstances(f,m,i.count);else if(n.isInstancedBufferGeometry){let e=n._maxInstanceCount===void 0?1/0:n._maxInstanceCount,t=Math.min(n.instanceCount,e);g.renderInstances(f,m,t)}else g.render(f,m)};function Ke(e,t,n,r){D!==null&&e.isNodeMaterial&&D.setObject(r,e),de===!0&&ke.setState(e,n,!1),e.transparent===!0&&e.side===2&&e.forceSinglePass===!1?(e.side=1,e.needsUpdate=!0,it(e,t,r),e.side=0,e.needsUpdate=!0,it(e,t,r),e.side=2):it(e,t,r)}this.compile=function(e,t,n=null){n===null&&(n=e),D!==null&&D.renderStart(e,t,n),x=Oe.get(n),x.init(t),C.push(x),n.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),e!==n&&e.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),x.setupLights(),D!==null&&D.updateLights(x.state.lightsArray),fe=this.localClippingEnabled,de=ke.init(this.clippingPlanes,fe),de===!0&&ke.setGlobalState(this.clippingPlanes,t),D!==null&&Ae.render(x.state.shadowsArray,n,t);let r=new Set;return e.traverse(function(e){if(!(e.isMesh||e.isPoints||e.isLine||e.isSprite))return;let i=e.material;if(i){if(Array.isArray(i))for(let a=0;a<i.length;a++){let o=i[a];Ke(o,n,t,e),r.add(o)}else Ke(i,n,t,e),r.add(i)}}),x=C.pop(),D!==null&&D.renderEnd(),r},this.compileAsync=function(e,t,n=null){let r=this.compile(e,t,n);return new Promise(t=>{function n(){r.forEach(function(e){let t=W.get(e).currentProgram;(t===void 0||t.isReady())&&r.delete(e)}),r.size===0?t(e):setTimeout(n,10)}H.get(`KHR_parallel_shader_compile`)===null?setTimeout(n,10):n()})};let qe=null;function Je(e){qe&&qe(e)}function Ye(){Ze.stop()}function Xe(){Ze.start()}let Ze=new V_;Ze.setAnimationLoop(Je),typeof self<`u`&&Ze.setContext(self),this.setAnimationLoop=function(e){qe=e,ze.setAnimationLoop(e),e===null?Ze.stop():Ze.start()},ze.addEventListener(`sessionstart`,Ye),ze.addEventListener(`sessionend`,Xe),this.render=function(e,t){if(t!==void 0&&t.isCamera!==!0){q(`WebGLRenderer.render: camera is not an instance of THREE.Camera.`);return}if(E===!0)return;D!==null&&D.renderStart(e,t);let n=ze.enabled===!0&&ze.isPresenting===!0,r=w!==null&&(N===null||n)&&w.begin(T,N);if(e.matrixWorldAutoUpdate===!0&&e.updateMatrixWorld(),t.parent===null&&t.matrixWorldAutoUpdate===!0&&t.updateMatrixWorld(),ze.enabled===!0&&ze.isPresenting===!0&&(w===null||w.isCompositing()===!1)&&(ze.cameraAutoUpdate===!0&&ze.updateCamera(t),t=ze.getCamera()),e.isScene===!0&&e.onBeforeRender(T,e,t,N),x=Oe.get(e,C.length),x.init(t),x.state.textureUnits=G.getTextureUnits(),C.push(x),pe.multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse),t.isArrayCamera?ue.setFromArrayCamera(t):le.setFromProjectionMatrix(pe,wu,t.reversedDepth),fe=this.localClippingEnabled,de=ke.init(this.clippingPlanes,fe),b=De.get(e,S.length),b.init(),S.push(b),this.info.render.frame++,ze.enabled===!0&&ze.isPresenting===!0){let e=T.xr.getDepthSensingMesh();e!==null&&Qe(e,t,-1/0,T.sortObjects)}Qe(e,t,0,T.sortObjects),b.finish(),D!==null&&D.updateLights(x.state.lightsArray),T.sortObjects===!0&&b.sort(z,ae),_e=ze.enabled===!1||ze.isPresenting===!1||ze.hasDepthSensing()===!1,_e&&je.addToRenderList(b,e),this.info.autoReset===!0&&this.info.reset(),de===!0&&ke.beginShadows();let i=x.state.shadowsArray;if(Ae.render(i,e,t),de===!0&&ke.endShadows(),(r&&w.hasRenderPass())===!1){let n=b.opaque,r=b.transmissive;if(x.setupLights(),t.isArrayCamera){let i=t.cameras;if(r.length>0)for(let t=0,a=i.length;t<a;t++){let a=i[t];et(n,r,e,a)}_e&&je.render(e);for(let t=0,n=i.length;t<n;t++){let n=i[t];$e(b,e,n,n.viewport)}}else r.length>0&&et(n,r,e,t),_e&&je.render(e),$e(b,e,t)}N!==null&&M===0&&(G.updateMultisampleRenderTarget(N),G.updateRenderTargetMipmap(N)),r&&w.end(T),e.isScene===!0&&e.onAfterRender(T,e,t),Ie.resetDefaultState(),ee=-1,te=null,C.pop(),C.length>0?(x=C[C.length-1],G.setTextureUnits(x.state.textureUnits),de===!0&&ke.setGlobalState(T.clippingPlanes,x.state.camera)):x=null,S.pop(),b=S.length>0?S[S.length-1]:null,D!==null&&D.renderEnd()};function Qe(e,t,n,r){if(e.visible===!1)return;if(e.layers.test(t.layers)){if(e.isGroup)n=e.renderOrder;else if(e.isLOD)e.autoUpdate===!0&&e.update(t);else if(e.isLight)x.pushLight(e),e.castShadow&&x.pushShadow(e);else if(e.isSprite){let i=t.isArrayCamera?ue:le;if(!e.frustumCulled||e.intersectsFrustum(i)){r&&he.setFromMatrixPosition(e.matrixWorld).applyMatrix4(pe);let i=we.update(e),a=e.material;a.visible&&b.push(e,i,a,n,he.z,null,t)}}else if(e.isMesh||e.isLine||e.isPoints){let i=t.isArrayCamera?ue:le;if(!e.frustumCulled||e.intersectsFrustum(i)){let i=we.update(e),a=e.material;if(r&&(e.boundingSphere===void 0?(i.boundingSphere===null&&i.computeBoundingSphere(),he.copy(i.boundingSphere.center)):(e.boundingSphere===null&&e.computeBoundingSphere(),he.copy(e.boundingSphere.center)),he.applyMatrix4(e.matrixWorld).applyMatrix4(pe)),Array.isArray(a)){let r=i.groups;for(let o=0,s=r.length;o<s;o++){let s=r[o],c=a[s.materialIndex];c&&c.visible&&b.push(e,i,c,n,he.z,s,t)}}else a.visible&&b.push(e,i,a,n,he.z,null,t)}}}let i=e.children;for(let e=0,a=i.length;e<a;e++)Qe(i[e],t,n,r)}function $e(e,t,n,r){let{opaque:i,transmissive:a,transparent:o}=e;x.setupLightsView(n),de===!0&&ke.setGlobalState(T.clippingPlanes,n),r&&U.viewport(ne.copy(r)),i.length>0&&tt(i,t,n),a.length>0&&tt(a,t,n),o.length>0&&tt(o,t,n),U.buffers.depth.setTest(!0),U.buffers.depth.setMask(!0),U.buffers.color.setMask(!0),U.setPolygonOffset(!1)}function et(e,t,n,r){if((n.isScene===!0?n.overrideMaterial:null)!==null)return;if(x.state.transmissionRenderTarget[r.id]===void 0){let e=H.has(`EXT_color_buffer_half_float`)||H.has(`EXT_color_buffer_float`);x.state.transmissionRenderTarget[r.id]=new Ad(1,1,{generateMipmaps:!0,type:e?dl:il,minFilter:rl,samples:Math.max(4,ye.samples),stencilBuffer:i,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:_d.workingColorSpace})}let a=x.state.transmissionRenderTarget[r.id],o=r.viewport||ne;a.setSize(o.z*T.transmissionResolutionScale,o.w*T.transmissionResolutionScale);let s=T.getRenderTarget(),c=T.getActiveCubeFace(),l=T.getActiveMipmapLevel();T.setRenderTarget(a),T.getClearColor(F),ie=T.getClearAlpha(),ie<1&&T.setClearColor(16777215,.5),T.clear(),_e&&je.render(n);let u=T.toneMapping;T.toneMapping=0;let d=r.viewport;if(r.viewport!==void 0&&(r.viewport=void 0),x.setupLightsView(r),de===!0&&ke.setGlobalState(T.clippingPlanes,r),tt(e,n,r),G.updateMultisampleRenderTarget(a),G.updateRenderTargetMipmap(a),H.has(`WEBGL_multisampled_render_to_texture`)===!1){let e=!1;for(let i=0,a=t.length;i<a;i++){let{object:a,geometry:o,material:s,group:c}=t[i];if(s.side===2&&a.layers.test(r.layers)){let t=s.side;s.side=1,s.needsUpdate=!0,nt(a,n,r,o,s,c),s.side=t,s.needsUpdate=!0,e=!0}}e===!0&&(G.updateMultisampleRenderTarget(a),G.updateRenderTargetMipmap(a))}T.setRenderTarget(s,c,l),T.setClearColor(F,ie),d!==void 0&&(r.viewport=d),T.toneMapping=u}function tt(e,t,n){let r=t.isScene===!0?t.overrideMaterial:null;for(let i=0,a=e.length;i<a;i++){let a=e[i],{object:o,geometry:s,group:c}=a,l=a.material;l.allowOverride===!0&&r!==null&&(l=r),o.layers.test(n.layers)&&nt(o,t,n,s,l,c)}}function nt(e,t,n,r,i,a){D!==null&&i.isNodeMaterial&&D.setObject(e,i),e.onBeforeRender(T,t,n,r,i,a),e.modelViewMatrix.multiplyMatrices(n.matrixWorldInverse,e.matrixWorld),e.normalMatrix.getNormalMatrix(e.modelViewMatrix),i.onBeforeRender(T,t,n,r,e,a),i.transparent===!0&&i.side===2&&i.forceSinglePass===!1?(i.side=1,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=0,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=2):T.renderBufferDirect(n,t,r,i,e,a),e.onAfterRender(T,t,n,r,i,a)}function rt(e){let t=0;for(let n of e)n.texture!==null&&t++;return t}function it(e,t,n){t.isScene!==!0&&(t=ge);let r=W.get(e),i=x.state.lights,a=x.state.shadowsArray,o=i.state.version,s=Te.getParameters(e,i.state,a,t,n,x.state.lightProbeGridArray),c=Te.getProgramCacheKey(s),l=r.programs;r.environment=e.isMeshStandardMaterial||e.isMeshLambertMaterial||e.isMeshPhongMaterial?t.environment:null,r.fog=t.fog;let u=e.isMeshStandardMaterial||e.isMeshLambertMaterial&&!e.envMap||e.isMeshPhongMaterial&&!e.envMap;r.envMap=xe.get(e.envMap||r.environment,u),r.envMapRotation=r.environment!==null&&e.envMap===null?t.environmentRotation:e.envMapRotation,l===void 0&&(e.addEventListener(`dispose`,Ue),l=new Map,r.programs=l,r.programVariants=new Map);let d=l.get(c);if(d!==void 0){if(r.currentProgram===d&&r.lightsStateVersion===o)return st(e,s),d}else s.uniforms=Te.getUniforms(e),D!==null&&e.isNodeMaterial&&D.build(e,n,s),e.onBeforeCompile(s,T),d=Te.acquireProgram(s,c),l.set(c,d),r.uniforms=s.uniforms;let f=r.uniforms;return(!e.isShaderMaterial&&!e.isRawShaderMaterial||e.clipping===!0)&&(f.clippingPlanes=ke.uniform),st(e,s),r.needsLights=ut(e),r.lightsStateVersion=o,r.needsLights&&(f.ambientLightColor.value=i.state.ambient,f.lightProbe.value=i.state.probe,f.sunLights.value=i.state.sun,f.sunLightShadows.value=i.state.sunShadow,f.directionalLights.value=i.state.directional,f.directionalLightShadows.value=i.state.directionalShadow,f.spotLights.value=i.state.spot,f.spotLightShadows.value=i.state.spotShadow,f.rectAreaLights.value=i.state.rectArea,f.ltc_1.value=i.state.rectAreaLTC1,f.ltc_2.value=i.state.rectAreaLTC2,f.pointLights.value=i.state.point,f.pointLightShadows.value=i.state.pointShadow,f.hemisphereLights.value=i.state.hemi,f.sunShadowMatrix.value=i.state.sunShadowMatrix,f.sunShadowCascade.value=i.state.sunShadowCascade,f.directionalShadowMatrix.value=i.state.directionalShadowMatrix,f.spotLightMatrix.value=i.state.spotLightMatrix,f.spotLightMap.value=i.state.spotLightMap,f.pointShadowMatrix.value=i.state.pointShadowMatrix),r.numLightProbeGrids=rt(x.state.lightProbeGridArray),r.currentProgram=d,r.uniformsList=null,d}function at(e,t,n,r,i){let a=W.get(e),o=a.currentProgram.id+`,`+r+`,`+i,s=a.programVariants.get(o);return s===void 0?(s=it(e,t,n),a.programVariants.set(o,s)):(a.currentProgram=s,a.uniformsList=null,a.outputColorSpace=r,a.toneMapping=i),s}function ot(e){if(e.uniformsList===null){let t=e.currentProgram.getUniforms();e.uniformsList=Ny.seqWithValue(t.seq,e.uniforms)}return e.uniformsList}function st(e,t){let n=W.get(e);n.outputColorSpace=t.outputColorSpace,n.batching=t.batching,n.batchingColor=t.batchingColor,n.instancing=t.instancing,n.instancingColor=t.instancingColor,n.instancingMorph=t.instancingMorph,n.skinning=t.skinning,n.morphTargets=t.morphTargets,n.morphNormals=t.morphNormals,n.morphColors=t.morphColors,n.morphTargetsCount=t.morphTargetsCount,n.numClippingPlanes=t.numClippingPlanes,n.numIntersection=t.numClipIntersection,n.vertexAlphas=t.vertexAlphas,n.vertexTangents=t.vertexTangents,n.toneMapping=t.toneMapping}function ct(e,t,n,r,i){t.isScene!==!0&&(t=ge),G.resetTextureUnits();let a=t.fog,o=r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial?t.environment:null,s=N===null?T.outputColorSpace:N.isXRRenderTarget===!0?N.texture.colorSpace:_d.workingColorSpace,c=r.isMeshStandardMaterial||r.isMeshLambertMaterial&&!r.envMap||r.isMeshPhongMaterial&&!r.envMap,l=xe.get(r.envMap||o,c),u=r.vertexColors===!0&&!!n.attributes.color&&n.attributes.color.itemSize===4,d=!!n.attributes.tangent&&(!!r.normalMap||r.anisotropy>0),f=!!n.morphAttributes.position,p=!!n.morphAttributes.normal,m=!!n.morphAttributes.color,h=0;r.toneMapped&&(N===null||N.isXRRenderTarget===!0)&&(h=T.toneMapping);let g=n.morphAttributes.position||n.morphAttributes.normal||n.morphAttributes.color,_=g===void 0?0:g.length,v=W.get(r),b=x.state.lights;if(de===!0&&(fe===!0||e!==te)){let t=e===te&&r.id===ee;ke.setState(r,e,t)}let S=!1,C=!1;r.version===v.__version?v.needsLights&&v.lightsStateVersion!==b.state.version||i.isBatchedMesh&&v.batching===!1||!i.isBatchedMesh&&v.batching===!0||i.isBatchedMesh&&v.batchingColor===!0&&i._colorsTexture===null||i.isBatchedMesh&&v.batchingColor===!1&&i._colorsTexture!==null||i.isInstancedMesh&&v.instancing===!1||!i.isInstancedMesh&&v.instancing===!0||i.isSkinnedMesh&&v.skinning===!1||!i.isSkinnedMesh&&v.skinning===!0||i.isInstancedMesh&&v.instancingColor===!0&&i.instanceColor===null||i.isInstancedMesh&&v.instancingColor===!1&&i.instanceColor!==null||i.isInstancedMesh&&v.instancingMorph===!0&&i.morphTexture===null||i.isInstancedMesh&&v.instancingMorph===!1&&i.morphTexture!==null?S=!0:v.envMap===l?r.fog===!0&&v.fog!==a||v.numClippingPlanes!==void 0&&(v.numClippingPlanes!==ke.numPlanes||v.numIntersection!==ke.numIntersection)?S=!0:v.vertexAlphas===u&&v.vertexTangents===d&&v.morphTargets===f&&v.morphNormals===p&&v.morphColors===m&&v.morphTargetsCount===_&&v.numLightProbeGrids===rt(x.state.lightProbeGridArray)?(v.outputColorSpace!==s||v.toneMapping!==h)&&(C=!0):S=!0:S=!0:(S=!0,v.__version=r.version);let w=v.currentProgram;(S===!0||C===!0)&&(w=C===!0?at(r,t,i,s,h):it(r,t,i),D&&r.isNodeMaterial&&D.onUpdateProgram(r,w,v));let E=!1,O=!1,k=!1,A=w.getUniforms(),j=v.uniforms;if(U.useProgram(w.program)&&(E=!0,O=!0,k=!0),r.id!==ee&&(ee=r.id,O=!0),E||te!==e){U.buffers.depth.getReversed()&&e.reversedDepth!==!0&&(e._reversedDepth=!0,e.updateProjectionMatrix()),A.setValue(B,`projectionMatrix`,e.projectionMatrix),A.setValue(B,`viewMatrix`,e.matrixWorldInverse);let t=A.map.cameraPosition;t!==void 0&&t.setValue(B,me.setFromMatrixPosition(e.matrixWorld)),ye.logarithmicDepthBuffer&&A.setValue(B,`logDepthBufFC`,2/(Math.log(e.far+1)/Math.LN2)),(r.isMeshPhongMaterial||r.isMeshToonMaterial||r.isMeshLambertMaterial||r.isMeshBasicMaterial||r.isMeshStandardMaterial||r.isShaderMaterial)&&A.setValue(B,`isOrthographic`,e.isOrthographicCamera===!0),te!==e&&(te=e,O=!0,k=!0)}if(v.needsLights&&(b.state.sunShadowMap.length>0&&A.setValue(B,`sunShadowMap`,b.state.sunShadowMap,G),b.state.directionalShadowMap.length>0&&A.setValue(B,`directionalShadowMap`,b.state.directionalShadowMap,G),b.state.spotShadowMap.length>0&&A.setValue(B,`spotShadowMap`,b.state.spotShadowMap,G),b.state.pointShadowMap.length>0&&A.setValue(B,`pointShadowMap`,b.state.pointShadowMap,G)),i.isSkinnedMesh){A.setOptional(B,i,`bindMatrix`),A.setOptional(B,i,`bindMatrixInverse`);let e=i.skeleton;e&&(e.boneTexture===null&&e.computeBoneTexture(),A.setValue(B,`boneTexture`,e.boneTexture,G))}i.isBatchedMesh&&(A.setOptional(B,i,`batchingTexture`),A.setValue(B,`batchingTexture`,i._matricesTexture,G),A.setOptional(B,i,`batchingIdTexture`),A.setValue(B,`batchingIdTexture`,i._indirectTexture,G),A.setOptional(B,i,`batchingColorTexture`),i._colorsTexture!==null&&A.setValue(B,`batchingColorTexture`,i._colorsTexture,G));let M=n.morphAttributes;if((M.position!==void 0||M.normal!==void 0||M.color!==void 0)&&Me.update(i,n,w),(O||v.receiveShadow!==i.receiveShadow)&&(v.receiveShadow=i.receiveShadow,A.setValue(B,`receiveShadow`,i.receiveShadow)),(r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial)&&r.envMap===null&&t.environment!==null&&(j.envMapIntensity.value=t.environmentIntensity),j.dfgLUT!==void 0&&(j.dfgLUT.value=Xb()),O){if(A.setValue(B,`toneMappingExposure`,T.toneMappingExposure),v.needsLights&&lt(j,k),a&&r.fog===!0&&Ee.refreshFogUniforms(j,a),Ee.refreshMaterialUniforms(j,r,R,L,x.state.transmissionRenderTarget[e.id]),v.needsLights&&v.numLightProbeGrids>0){let e=y,t=0;for(let n of x.state.lightProbeGridArray)n.texture!==null&&(e.textures[t]=n.texture,e.min[t]=n.boundingBox.min,e.max[t]=n.boundingBox.max,e.resolution[t]=n.resolution,t++);for(let n in e)e[n].length=t;j.probesSH.value=e.textures,j.probesMin.value=e.min,j.probesMax.value=e.max,j.probesResolution.value=e.resolution}Ny.upload(B,ot(v),j,G)}if(r.isShaderMaterial&&r.uniformsNeedUpdate===!0&&(Ny.upload(B,ot(v),j,G),r.uniformsNeedUpdate=!1),r.isSpriteMaterial&&A.setValue(B,`center`,i.center),A.setValue(B,`modelViewMatrix`,i.modelViewMatrix),A.setValue(B,`normalMatrix`,i.normalMatrix),A.setValue(B,`modelMatrix`,i.matrixWorld),r.uniformsGroups!==void 0){let e=r.uniformsGroups;for(let t=0,n=e.length;t<n;t++){let n=e[t];Le.update(n,w),Le.bind(n,w)}}return w}function lt(e,t){e.ambientLightColor.needsUpdate=t,e.lightProbe.needsUpdate=t,e.sunLights.needsUpdate=t,e.sunLightShadows.needsUpdate=t,e.directionalLights.needsUpdate=t,e.directionalLightShadows.needsUpdate=t,e.pointLights.needsUpdate=t,e.pointLightShadows.needsUpdate=t,e.spotLights.needsUpdate=t,e.spotLightShadows.needsUpdate=t,e.rectAreaLights.needsUpdate=t,e.hemisphereLights.needsUpdate=t}function ut(e){return e.isMeshLambertMaterial||e.isMeshToonMaterial||e.isMeshPhongMaterial||e.isMeshStandardMaterial||e.isShadowMaterial||e.isShaderMaterial&&e.lights===!0}this.getActiveCubeFace=function(){return j},this.getActiveMipmapLevel=function(){return M},this.getRenderTarget=function(){return N},this.setRenderTargetTextures=function(e,t,n){let r=W.get(e);r.__autoAllocateDepthBuffer=e.resolveDepthBuffer===!1,r.__autoAllocateDepthBuffer===!1&&(r.__useRenderToTexture=!1),W.get(e.texture).__webglTexture=t,W.get(e.depthTexture).__webglTexture=r.__autoAllocateDepthBuffer?void 0:n,r.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(e,t){let n=W.get(e);n.__webglFramebuffer=t,n.__useDefaultFramebuffer=t===void 0},this.setRenderTarget=function(e,t=0,n=0){N=e,j=t,M=n;let r=null,i=!1,a=!1;if(e){let o=W.get(e);if(o.__useDefaultFramebuffer!==void 0){U.bindFramebuffer(B.FRAMEBUFFER,o.__webglFramebuffer),ne.copy(e.viewport),re.copy(e.scissor),P=e.scissorTest,U.viewport(ne),U.scissor(re),U.setScissorTest(P),ee=-1;return}if(o.__webglFramebuffer===void 0)G.setupRenderTarget(e);else if(o.__hasExternalTextures)G.rebindTextures(e,W.get(e.texture).__webglTexture,W.get(e.depthTexture).__webglTexture);else if(e.depthBuffer){let t=e.depthTexture;if(o.__boundDepthTexture!==t){if(t!==null&&W.has(t)&&(e.width!==t.image.width||e.height!==t.image.height))throw Error(`THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.`);G.setupDepthRenderbuffer(e)}}let s=e.texture;(s.isData3DTexture||s.isDataArrayTexture||s.isCompressedArrayTexture)&&(a=!0);let c=W.get(e).__webglFramebuffer;e.isWebGLCubeRenderTarget?(r=Array.isArray(c[t])?c[t][n]:c[t],i=!0):r=e.samples>0&&G.useMultisampledRTT(e)===!1?W.get(e).__webglMultisampledFramebuffer:Array.isArray(c)?c[n]:c,ne.copy(e.viewport),re.copy(e.scissor),P=e.scissorTest}else ne.copy(oe).multiplyScalar(R).floor(),re.copy(se).multiplyScalar(R).floor(),P=ce;if(n!==0&&(r=O),U.bindFramebuffer(B.FRAMEBUFFER,r)&&U.drawBuffers(e,r),U.viewport(ne),U.scissor(re),U.setScissorTest(P),i){let r=W.get(e.texture);B.framebufferTexture2D(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_CUBE_MAP_POSITIVE_X+t,r.__webglTexture,n)}else if(a){let r=t;for(let t=0;t<e.textures.length;t++){let i=W.get(e.textures[t]);B.framebufferTextureLayer(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0+t,i.__webglTexture,n,r)}}else if(e!==null&&n!==0){let t=W.get(e.texture);B.framebufferTexture2D(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,t.__webglTexture,n)}ee=-1};function dt(e){let t=W.get(e);return(t.__readFormat!==e.format||t.__readType!==e.type)&&(t.__readFormat=e.format,t.__readType=e.type,t.__formatReadable=ye.textureFormatReadable(e.format),t.__typeReadable=ye.textureTypeReadable(e.type)),t}this.readRenderTargetPixels=function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget)){q(`WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);return}let c=W.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){U.bindFramebuffer(B.FRAMEBUFFER,c);try{let o=e.textures[s],c=o.format,l=o.type;e.textures.length>1&&B.readBuffer(B.COLOR_ATTACHMENT0+s);let u=dt(o);if(u.__formatReadable===!1){q(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.`);return}if(u.__typeReadable===!1){q(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.`);return}t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i&&B.readPixels(t,n,r,i,Fe.convert(c),Fe.convert(l),a)}finally{let e=N===null?null:W.get(N).__webglFramebuffer;U.bindFramebuffer(B.FRAMEBUFFER,e)}}},this.readRenderTargetPixelsAsync=async function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget))throw Error(`THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);let c=W.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){if(t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i){U.bindFramebuffer(B.FRAMEBUFFER,c);let o=e.textures[s],l=o.format,u=o.type;e.textures.length>1&&B.readBuffer(B.COLOR_ATTACHMENT0+s);let d=dt(o);if(d.__formatReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.`);if(d.__typeReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.`);let f=B.createBuffer();B.bindBuffer(B.PIXEL_PACK_BUFFER,f),B.bufferData(B.PIXEL_PACK_BUFFER,a.byteLength,B.STREAM_READ),B.readPixels(t,n,r,i,Fe.convert(l),Fe.convert(u),0),B.bindBuffer(B.PIXEL_PACK_BUFFER,null);let p=N===null?null:W.get(N).__webglFramebuffer;U.bindFramebuffer(B.FRAMEBUFFER,p);let m=B.fenceSync(B.SYNC_GPU_COMMANDS_COMPLETE,0);return B.flush(),await Nu(B,m,4),B.bindBuffer(B.PIXEL_PACK_BUFFER,f),B.getBufferSubData(B.PIXEL_PACK_BUFFER,0,a),B.bindBuffer(B.PIXEL_PACK_BUFFER,null),B.deleteBuffer(f),B.deleteSync(m),a}throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.`)}},this.copyFramebufferToTexture=function(e,t=null,n=0){let r=2**-n,i=Math.floor(e.image.width*r),a=Math.floor(e.image.height*r),o=t===null?0:t.x,s=t===null?0:t.y;G.setTexture2D(e,0),B.copyTexSubImage2D(B.TEXTURE_2D,n,0,0,o,s,i,a),U.unbindTexture()},this.copyTextureToTexture=function(e,t,n=null,r=null,i=0,a=0){let o,s,c,l,u,d,f,p,m,h=e.isCompressedTexture?e.mipmaps[a]:e.image;if(n!==null)o=n.max.x-n.min.x,s=n.max.y-n.min.y,c=n.isBox3?n.max.z-n.min.z:1,l=n.min.x,u=n.min.y,d=n.isBox3?n.min.z:0;else{let t=2**-i;o=Math.floor(h.width*t),s=Math.floor(h.height*t),c=e.isDataArrayTexture?h.depth:e.isData3DTexture?Math.floor(h.depth*t):1,l=0,u=0,d=0}r===null?(f=0,p=0,m=0):(f=r.x,p=r.y,m=r.z);let g=Fe.convert(t.format),_=Fe.convert(t.type),v;t.isData3DTexture?(G.setTexture3D(t,0),v=B.TEXTURE_3D):t.isDataArrayTexture||t.isCompressedArrayTexture?(G.setTexture2DArray(t,0),v=B.TEXTURE_2D_ARRAY):(G.setTexture2D(t,0),v=B.TEXTURE_2D),U.activeTexture(B.TEXTURE0),U.pixelStorei(B.UNPACK_FLIP_Y_WEBGL,t.flipY),U.pixelStorei(B.UNPACK_PREMULTIPLY_ALPHA_WEBGL,t.premultiplyAlpha),U.pixelStorei(B.UNPACK_ALIGNMENT,t.unpackAlignment);let y=U.getParameter(B.UNPACK_ROW_LENGTH),b=U.getParameter(B.UNPACK_IMAGE_HEIGHT),x=U.getParameter(B.UNPACK_SKIP_PIXELS),S=U.getParameter(B.UNPACK_SKIP_ROWS),C=U.getParameter(B.UNPACK_SKIP_IMAGES);U.pixelStorei(B.UNPACK_ROW_LENGTH,h.width),U.pixelStorei(B.UNPACK_IMAGE_HEIGHT,h.height),U.pixelStorei(B.UNPACK_SKIP_PIXELS,l),U.pixelStorei(B.UNPACK_SKIP_ROWS,u),U.pixelStorei(B.UNPACK_SKIP_IMAGES,d);let w=e.isDataArrayTexture||e.isData3DTexture,T=t.isDataArrayTexture||t.isData3DTexture;if(e.isDepthTexture){let n=W.get(e),r=W.get(t),h=W.get(n.__renderTarget),g=W.get(r.__renderTarget);U.bindFramebuffer(B.READ_FRAMEBUFFER,h.__webglFramebuffer),U.bindFramebuffer(B.DRAW_FRAMEBUFFER,g.__webglFramebuffer);for(let n=0;n<c;n++)w&&(B.framebufferTextureLayer(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,W.get(e).__webglTexture,i,d+n),B.framebufferTextureLayer(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,W.get(t).__webglTexture,a,m+n)),B.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,B.DEPTH_BUFFER_BIT,B.NEAREST);U.bindFramebuffer(B.READ_FRAMEBUFFER,null),U.bindFramebuffer(B.DRAW_FRAMEBUFFER,null)}else if(i!==0||e.isRenderTargetTexture||W.has(e)){let n=W.get(e),r=W.get(t);U.bindFramebuffer(B.READ_FRAMEBUFFER,k),U.bindFramebuffer(B.DRAW_FRAMEBUFFER,A);for(let e=0;e<c;e++)w?B.framebufferTextureLayer(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,n.__webglTexture,i,d+e):B.framebufferTexture2D(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,n.__webglTexture,i),T?B.framebufferTextureLayer(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,r.__webglTexture,a,m+e):B.framebufferTexture2D(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,r.__webglTexture,a),i===0?T?B.copyTexSubImage3D(v,a,f,p,m+e,l,u,o,s):B.copyTexSubImage2D(v,a,f,p,l,u,o,s):B.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,B.COLOR_BUFFER_BIT,B.NEAREST);U.bindFramebuffer(B.READ_FRAMEBUFFER,null),U.bindFramebuffer(B.DRAW_FRAMEBUFFER,null)}else T?e.isDataTexture||e.isData3DTexture?B.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h.data):t.isCompressedArrayTexture?B.compressedTexSubImage3D(v,a,f,p,m,o,s,c,g,h.data):B.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h):e.isDataTexture?B.texSubImage2D(B.TEXTURE_2D,a,f,p,o,s,g,_,h.data):e.isCompressedTexture?B.compressedTexSubImage2D(B.TEXTURE_2D,a,f,p,h.width,h.height,g,h.data):B.texSubImage2D(B.TEXTURE_2D,a,f,p,o,s,g,_,h);U.pixelStorei(B.UNPACK_ROW_LENGTH,y),U.pixelStorei(B.UNPACK_IMAGE_HEIGHT,b),U.pixelStorei(B.UNPACK_SKIP_PIXELS,x),U.pixelStorei(B.UNPACK_SKIP_ROWS,S),U.pixelStorei(B.UNPACK_SKIP_IMAGES,C),a===0&&t.generateMipmaps===!0&&t.mipmapsAutoUpdate===!0&&B.generateMipmap(v),U.unbindTexture()},this.initRenderTarget=function(e){W.get(e).__webglFramebuffer===void 0&&G.setupRenderTarget(e)},this.initTexture=function(e){e.isCubeTexture?G.setTextureCube(e,0):e.isData3DTexture?G.setTexture3D(e,0):e.isDataArrayTexture||e.isCompressedArrayTexture?G.setTexture2DArray(e,0):G.setTexture2D(e,0),U.unbindTexture()},this.resetState=function(){j=0,M=0,N=null,U.reset(),Ie.reset()},typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}get coordinateSystem(){return wu}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=_d._getDrawingBufferColorSpace(e),t.unpackColorSpace=_d._getUnpackColorSpace()}},Qb={type:`change`},$b={type:`start`},ex={type:`end`},tx=new wp,nx=new _p,rx=Math.cos(70*cd.DEG2RAD),ix=new X,ax=2*Math.PI,ox={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},sx=1e-6,cx=class extends R_{constructor(e,t=null){super(e,t),this.state=ox.NONE,this.target=new X,this.cursor=new X,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:`ArrowLeft`,UP:`ArrowUp`,RIGHT:`ArrowRight`,BOTTOM:`ArrowDown`},this.mouseButtons={LEFT:qc.ROTATE,MIDDLE:qc.DOLLY,RIGHT:qc.PAN},this.touches={ONE:Jc.ROTATE,TWO:Jc.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle=`auto`,this._domElementKeyEvents=null,this._lastPosition=new X,this._lastQuaternion=new ld,this._lastTargetPosition=new X,this._quat=new ld().setFromUnitVectors(e.up,new X(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new k_,this._sphericalDelta=new k_,this._scale=1,this._panOffset=new X,this._rotateStart=new Y,this._rotateEnd=new Y,this._rotateDelta=new Y,this._panStart=new Y,this._panEnd=new Y,this._panDelta=new Y,this._dollyStart=new Y,this._dollyEnd=new Y,this._dollyDelta=new Y,this._dollyDirection=new X,this._mouse=new Y,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=ux.bind(this),this._onPointerDown=lx.bind(this),this._onPointerUp=dx.bind(this),this._onContextMenu=vx.bind(this),this._onMouseWheel=mx.bind(this),this._onKeyDown=hx.bind(this),this._onTouchStart=gx.bind(this),this._onTouchMove=_x.bind(this),this._onMouseDown=fx.bind(this),this._onMouseMove=px.bind(this),this._interceptControlDown=yx.bind(this),this._interceptControlUp=bx.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e===`grab`?this.domElement.style.cursor=`grab`:this.domElement.style.cursor=`auto`}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener(`pointerdown`,this._onPointerDown),this.domElement.addEventListener(`pointercancel`,this._onPointerUp),this.domElement.addEventListener(`contextmenu`,this._onContextMenu),this.domElement.addEventListener(`wheel`,this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener(`keydown`,this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction=`none`}disconnect(){this.state=ox.NONE,this.domElement.removeEventListener(`pointerdown`,this._onPointerDown),this.domElement.ownerDocument.removeEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.removeEventListener(`pointerup`,this._onPointerUp),this.domElement.removeEventListener(`pointercancel`,this._onPointerUp),this.domElement.removeEventListener(`wheel`,this._onMouseWheel),this.domElement.removeEventListener(`contextmenu`,this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener(`keydown`,this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener(`keyup`,this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction=``,this.domElement.style.cursor=`auto`}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener(`keydown`,this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener(`keydown`,this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Qb),this.update(),this.state=ox.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;ix.copy(t).sub(this.target),ix.applyQuaternion(this._quat),this._spherical.setFromVector3(ix),this.autoRotate&&this.state===ox.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,r=this.maxAzimuthAngle;isFinite(n)&&isFinite(r)&&(n<-Math.PI?n+=ax:n>Math.PI&&(n-=ax),r<-Math.PI?r+=ax:r>Math.PI&&(r-=ax),n<=r?this._spherical.theta=Math.max(n,Math.min(r,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+r)/2?Math.max(n,this._spherical.theta):Math.min(r,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let i=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let e=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),i=e!=this._spherical.radius}if(ix.setFromSpherical(this._spherical),ix.applyQuaternion(this._quatInverse),t.copy(this.target).add(ix),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let e=null;if(this.object.isPerspectiveCamera){let t=ix.length();e=this._clampDistance(t*this._scale);let n=t-e;this.object.position.addScaledVector(this._dollyDirection,n),this.object.updateMatrixWorld(),i=!!n}else if(this.object.isOrthographicCamera){let t=new X(this._mouse.x,this._mouse.y,0);t.unproject(this.object);let n=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),i=n!==this.object.zoom;let r=new X(this._mouse.x,this._mouse.y,0);r.unproject(this.object),this.object.position.sub(r).add(t),this.object.updateMatrixWorld(),e=ix.length()}else console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled.`),this.zoomToCursor=!1;e!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(e).add(this.object.position):(tx.origin.copy(this.object.position),tx.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(tx.direction))<rx?this.object.lookAt(this.target):(nx.setFromNormalAndCoplanarPoint(this.object.up,this.target),tx.intersectPlane(nx,this.target))))}else if(this.object.isOrthographicCamera){let e=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),e!==this.object.zoom&&(this.object.updateProjectionMatrix(),i=!0)}return this._scale=1,this._performCursorZoom=!1,i||this._lastPosition.distanceToSquared(this.object.position)>sx||8*(1-this._lastQuaternion.dot(this.object.quaternion))>sx||this._lastTargetPosition.distanceToSquared(this.target)>sx?(this.dispatchEvent(Qb),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e===null?ax/60/60*this.autoRotateSpeed:ax/60*this.autoRotateSpeed*e}_getZoomScale(e){let t=Math.abs(e*.01);return .95**(this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){ix.setFromMatrixColumn(t,0),ix.multiplyScalar(-e),this._panOffset.add(ix)}_panUp(e,t){this.screenSpacePanning===!0?ix.setFromMatrixColumn(t,1):(ix.setFromMatrixColumn(t,0),ix.crossVectors(this.object.up,ix)),ix.multiplyScalar(e),this._panOffset.add(ix)}_pan(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let r=this.object.position;ix.copy(r).sub(this.target);let i=ix.length();i*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*i/n.clientHeight,this.object.matrix),this._panUp(2*t*i/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - pan disabled.`),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled.`),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled.`),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),r=e-n.left,i=t-n.top,a=n.width,o=n.height;this._mouse.x=r/a*2-1,this._mouse.y=-(i/o)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ax*this._rotateDelta.x/t.clientHeight),this._rotateUp(ax*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(ax*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-ax*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(ax*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-ax*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._rotateStart.set(n,r)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._panStart.set(n,r)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,r=e.pageY-t.y,i=Math.sqrt(n*n+r*r);this._dollyStart.set(0,i)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._rotateEnd.set(n,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ax*this._rotateDelta.x/t.clientHeight),this._rotateUp(ax*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._panEnd.set(n,r)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,r=e.pageY-t.y,i=Math.sqrt(n*n+r*r);this._dollyEnd.set(0,i),this._dollyDelta.set(0,(this._dollyEnd.y/this._dollyStart.y)**+this.zoomSpeed),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let a=(e.pageX+t.x)*.5,o=(e.pageY+t.y)*.5;this._updateZoomParameters(a,o)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new Y,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function lx(e){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(e.pointerId),this.domElement.ownerDocument.addEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.addEventListener(`pointerup`,this._onPointerUp)),this._isTrackingPointer(e)||(this._addPointer(e),e.pointerType===`touch`?this._onTouchStart(e):this._onMouseDown(e),this._cursorStyle===`grab`&&(this.domElement.style.cursor=`grabbing`)))}function ux(e){this.enabled!==!1&&(e.pointerType===`touch`?this._onTouchMove(e):this._onMouseMove(e))}function dx(e){switch(this._removePointer(e),this._pointers.length){case 0:this.domElement.releasePointerCapture(e.pointerId),this.domElement.ownerDocument.removeEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.removeEventListener(`pointerup`,this._onPointerUp),this.dispatchEvent(ex),this.state=ox.NONE,this._cursorStyle===`grab`&&(this.domElement.style.cursor=`grab`);break;case 1:let t=this._pointers[0],n=this._pointerPositions[t];this._onTouchStart({pointerId:t,pageX:n.x,pageY:n.y})}}function fx(e){let t;switch(e.button){case 0:t=this.mouseButtons.LEFT;break;case 1:t=this.mouseButtons.MIDDLE;break;case 2:t=this.mouseButtons.RIGHT;break;default:t=-1}switch(t){case qc.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(e),this.state=ox.DOLLY;break;case qc.ROTATE:if(e.ctrlKey||e.metaKey||e.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(e),this.state=ox.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(e),this.state=ox.ROTATE}break;case qc.PAN:if(e.ctrlKey||e.metaKey||e.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(e),this.state=ox.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(e),this.state=ox.PAN}break;default:this.state=ox.NONE}this.state!==ox.NONE&&this.dispatchEvent($b)}function px(e){switch(this.state){case ox.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(e);break;case ox.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(e);break;case ox.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(e)}}function mx(e){this.enabled!==!1&&this.enableZoom!==!1&&this.state===ox.NONE&&(e.preventDefault(),this.dispatchEvent($b),this._handleMouseWheel(this._customWheelEvent(e)),this.dispatchEvent(ex))}function hx(e){this.enabled!==!1&&this._handleKeyDown(e)}function gx(e){switch(this._trackPointer(e),this._pointers.length){case 1:switch(this.touches.ONE){case Jc.ROTATE:if(this.enableRotate===!1){this.state=ox.NONE;break}this._handleTouchStartRotate(e),this.state=ox.TOUCH_ROTATE;break;case Jc.PAN:if(this.enablePan===!1){this.state=ox.NONE;break}this._handleTouchStartPan(e),this.state=ox.TOUCH_PAN;break;default:this.state=ox.NONE}break;case 2:switch(this.touches.TWO){case Jc.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(e),this.state=ox.TOUCH_DOLLY_PAN;break;case Jc.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(e),this.state=ox.TOUCH_DOLLY_ROTATE;break;default:this.state=ox.NONE}break;default:this.state=ox.NONE}this.state!==ox.NONE&&this.dispatchEvent($b)}function _x(e){switch(this._trackPointer(e),this.state){case ox.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(e),this.update();break;case ox.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(e),this.update();break;case ox.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(e),this.update();break;case ox.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(e),this.update();break;default:this.state=ox.NONE}}function vx(e){this.enabled!==!1&&e.preventDefault()}function yx(e){e.key===`Control`&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener(`keyup`,this._interceptControlUp,{passive:!0,capture:!0}))}function bx(e){e.key===`Control`&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener(`keyup`,this._interceptControlUp,{passive:!0,capture:!0}))}var xx={POSITION:[`byte`,`byte normalized`,`unsigned byte`,`unsigned byte normalized`,`short`,`short normalized`,`unsigned short`,`unsigned short normalized`],NORMAL:[`byte normalized`,`short normalized`],TANGENT:[`byte normalized`,`short normalized`],TEXCOORD:[`byte`,`byte normalized`,`unsigned byte`,`short`,`short normalized`,`unsigned short`]},Sx=class{constructor(){this.textureUtils=null,this.pluginCallbacks=[],this.register(function(e){return new Ux(e)}),this.register(function(e){return new Wx(e)}),this.register(function(e){return new Jx(e)}),this.register(function(e){return new Yx(e)}),this.register(function(e){return new Xx(e)}),this.register(function(e){return new Zx(e)}),this.register(function(e){return new Gx(e)}),this.register(function(e){return new Kx(e)}),this.register(function(e){return new qx(e)}),this.register(function(e){return new Qx(e)}),this.register(function(e){return new $x(e)}),this.register(function(e){return new eS(e)}),this.register(function(e){return new tS(e)}),this.register(function(e){return new nS(e)})}register(e){return this.pluginCallbacks.indexOf(e)===-1&&this.pluginCallbacks.push(e),this}unregister(e){return this.pluginCallbacks.indexOf(e)!==-1&&this.pluginCallbacks.splice(this.pluginCallbacks.indexOf(e),1),this}setTextureUtils(e){return this.textureUtils=e,this}parse(e,t,n,r){let i=new Hx,a=[];for(let e=0,t=this.pluginCallbacks.length;e<t;e++)a.push(this.pluginCallbacks[e](i));i.setPlugins(a),i.setTextureUtils(this.textureUtils),i.writeAsync(e,t,r).catch(n)}parseAsync(e,t){let n=this;return new Promise(function(r,i){n.parse(e,r,i,t)})}},Cx={POINTS:0,LINES:1,LINE_LOOP:2,LINE_STRIP:3,TRIANGLES:4,TRIANGLE_STRIP:5,TRIANGLE_FAN:6,BYTE:5120,UNSIGNED_BYTE:5121,SHORT:5122,UNSIGNED_SHORT:5123,INT:5124,UNSIGNED_INT:5125,FLOAT:5126,ARRAY_BUFFER:34962,ELEMENT_ARRAY_BUFFER:34963,NEAREST:9728,LINEAR:9729,NEAREST_MIPMAP_NEAREST:9984,LINEAR_MIPMAP_NEAREST:9985,NEAREST_MIPMAP_LINEAR:9986,LINEAR_MIPMAP_LINEAR:9987,CLAMP_TO_EDGE:33071,MIRRORED_REPEAT:33648,REPEAT:10497},wx=`KHR_mesh_quantization`,Tx={};Tx[Qc]=Cx.NEAREST,Tx[$c]=Cx.NEAREST_MIPMAP_NEAREST,Tx[el]=Cx.NEAREST_MIPMAP_LINEAR,Tx[tl]=Cx.LINEAR,Tx[nl]=Cx.LINEAR_MIPMAP_NEAREST,Tx[rl]=Cx.LINEAR_MIPMAP_LINEAR,Tx[Xc]=Cx.CLAMP_TO_EDGE,Tx[Yc]=Cx.REPEAT,Tx[Zc]=Cx.MIRRORED_REPEAT;var Ex={scale:`scale`,position:`translation`,quaternion:`rotation`,morphTargetInfluences:`weights`},Dx=new Z,Ox=12,kx=1179937895,Ax=2,jx=8,Mx=1313821514,Nx=5130562;function Px(e,t){return e.length===t.length&&e.every(function(e,n){return e===t[n]})}function Fx(e){return new TextEncoder().encode(e).buffer}function Ix(e){return Px(e.elements,[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])}function Lx(e,t,n){let r={min:Array(e.itemSize).fill(1/0),max:Array(e.itemSize).fill(-1/0)};for(let i=t;i<t+n;i++)for(let t=0;t<e.itemSize;t++){let n;e.itemSize>4?n=e.array[i*e.itemSize+t]:(t===0?n=e.getX(i):t===1?n=e.getY(i):t===2?n=e.getZ(i):t===3&&(n=e.getW(i)),e.normalized===!0&&(n=cd.normalize(n,e.array))),r.min[t]=Math.min(r.min[t],n),r.max[t]=Math.max(r.max[t],n)}return r}function Rx(e){return Math.ceil(e/4)*4}function zx(e,t=0){let n=Rx(e.byteLength);if(n!==e.byteLength){let r=new Uint8Array(n);if(r.set(new Uint8Array(e)),t!==0)for(let i=e.byteLength;i<n;i++)r[i]=t;return r.buffer}return e}function Bx(){return typeof document>`u`&&typeof OffscreenCanvas<`u`?new OffscreenCanvas(1,1):document.createElement(`canvas`)}function Vx(e,t){if(typeof OffscreenCanvas<`u`&&e instanceof OffscreenCanvas){let n;return t===`image/jpeg`?n=.92:t===`image/webp`&&(n=.8),e.convertToBlob({type:t,quality:n})}return new Promise(n=>e.toBlob(n,t))}var Hx=class{constructor(){this.plugins=[],this.options={},this.pending=[],this.buffers=[],this.byteOffset=0,this.buffers=[],this.nodeMap=new Map,this.skins=[],this.extensionsUsed={},this.extensionsRequired={},this.uids=new Map,this.uid=0,this.json={asset:{version:`2.0`,generator:`THREE.GLTFExporter r187`}},this.cache={meshes:new Map,attributes:new Map,attributesNormalized:new Map,materials:new Map,textures:new Map,images:new Map,normalMaps:new Map},this.textureUtils=null}setPlugins(e){this.plugins=e}setTextureUtils(e){this.textureUtils=e}async writeAsync(e,t,n={}){this.options=Object.assign({binary:!1,trs:!1,onlyVisible:!0,maxTextureSize:1/0,animations:[],includeCustomExtensions:!1,copyright:null},n),this.options.animations.length>0&&(this.options.trs=!0),await this.processInputAsync(e),await Promise.all(this.pending);let r=this,i=r.buffers,a=r.json;n=r.options;let o=r.extensionsUsed,s=r.extensionsRequired,c=new Blob(i,{type:`application/octet-stream`}),l=Object.keys(o),u=Object.keys(s);if(l.length>0&&(a.extensionsUsed=l),u.length>0&&(a.extensionsRequired=u),a.buffers&&a.buffers.length>0&&(a.buffers[0].byteLength=c.size),n.copyright&&(a.asset.copyright=n.copyright),n.binary===!0){let e=new FileReader;e.readAsArrayBuffer(c),e.onloadend=function(){let n=zx(e.result),r=new DataView(new ArrayBuffer(jx));r.setUint32(0,n.byteLength,!0),r.setUint32(4,Nx,!0);let i=zx(Fx(JSON.stringify(a)),32),o=new DataView(new ArrayBuffer(jx));o.setUint32(0,i.byteLength,!0),o.setUint32(4,Mx,!0);let s=new ArrayBuffer(Ox),c=new DataView(s);c.setUint32(0,kx,!0),c.setUint32(4,Ax,!0);let l=Ox+o.byteLength+i.byteLength+r.byteLength+n.byteLength;c.setUint32(8,l,!0);let u=new Blob([s,o,i,r,n],{type:`application/octet-stream`}),d=new FileReader;d.readAsArrayBuffer(u),d.onloadend=function(){t(d.result)}}}else if(a.buffers&&a.buffers.length>0){let e=new FileReader;e.readAsDataURL(c),e.onloadend=function(){let n=e.result;a.buffers[0].uri=n,t(a)}}else t(a)}serializeUserData(e,t){if(Object.keys(e.userData).length===0)return;let n=this.options,r=this.extensionsUsed;try{let i=JSON.parse(JSON.stringify(e.userData));if(n.includeCustomExtensions&&i.gltfExtensions){t.extensions===void 0&&(t.extensions={});for(let e in i.gltfExtensions)t.extensions[e]=i.gltfExtensions[e],r[e]=!0;delete i.gltfExtensions}Object.keys(i).length>0&&(t.extras=i)}catch(t){console.warn(`THREE.GLTFExporter: userData of '`+e.name+`' won't be serialized because of JSON.stringify error - `+t.message)}}getUID(e,t=!1){if(this.uids.has(e)===!1){let t=new Map;t.set(!0,this.uid++),t.set(!1,this.uid++),this.uids.set(e,t)}return this.uids.get(e).get(t)}isNormalizedNormalAttribute(e){if(this.cache.attributesNormalized.has(e))return!1;let t=new X;for(let n=0,r=e.count;n<r;n++)if(Math.abs(t.fromBufferAttribute(e,n).length()-1)>5e-4)return!1;return!0}createNormalizedNormalAttribute(e){let t=this.cache;if(t.attributesNormalized.has(e))return t.attributesNormalized.get(e);let n=e.clone(),r=new X;for(let e=0,t=n.count;e<t;e++)r.fromBufferAttribute(n,e),r.x===0&&r.y===0&&r.z===0?r.setX(1):r.normalize(),n.setXYZ(e,r.x,r.y,r.z);return t.attributesNormalized.set(e,n),n}applyTextureTransform(e,t){let n=!1,r={};(t.offset.x!==0||t.offset.y!==0)&&(r.offset=t.offset.toArray(),n=!0),t.rotation!==0&&(r.rotation=t.rotation,n=!0),(t.repeat.x!==1||t.repeat.y!==1)&&(r.scale=t.repeat.toArray(),n=!0),n&&(e.extensions=e.extensions||{},e.extensions.KHR_texture_transform=r,this.extensionsUsed.KHR_texture_transform=!0)}async buildMetalRoughTextureAsync(e,t){if(e===t)return e;function n(e){return e.colorSpace===`srgb`?function(e){return e<.04045?e*.0773993808:(e*.9478672986+.0521327014)**2.4}:function(e){return e}}e instanceof hm&&(e=await this.decompressTextureAsync(e)),t instanceof hm&&(t=await this.decompressTextureAsync(t));let r=e?e.image:null,i=t?t.image:null,a=Math.max(r?r.width:0,i?i.width:0),o=Math.max(r?r.height:0,i?i.height:0),s=Bx();s.width=a,s.height=o;let c=s.getContext(`2d`,{willReadFrequently:!0});c.fillStyle=`#00ffff`,c.fillRect(0,0,a,o);let l=c.getImageData(0,0,a,o);if(r){c.drawImage(r,0,0,a,o);let t=n(e),i=c.getImageData(0,0,a,o).data;for(let e=2;e<i.length;e+=4)l.data[e]=t(i[e]/256)*256}if(i){c.drawImage(i,0,0,a,o);let e=n(t),r=c.getImageData(0,0,a,o).data;for(let t=1;t<r.length;t+=4)l.data[t]=e(r[t]/256)*256}c.putImageData(l,0,0);let u=(e||t).clone();return u.source=new Cd(s),u.colorSpace=``,u.channel=(e||t).channel,e&&t&&e.channel!==t.channel&&console.warn(`THREE.GLTFExporter: UV channels for metalnessMap and roughnessMap textures must match.`),console.warn(`THREE.GLTFExporter: Merged metalnessMap and roughnessMap textures.`),u}async buildNormalMapTextureAsync(e,t,n){e instanceof hm&&(e=await this.decompressTextureAsync(e));let r=e.image,i=Bx();i.width=r.width,i.height=r.height;let a=i.getContext(`2d`,{willReadFrequently:!0});a.drawImage(r,0,0,i.width,i.height);let o=a.getImageData(0,0,i.width,i.height),s=o.data;for(let e=0;e<s.length;e+=4)t&&(s[e+0]=255-s[e+0]),n&&(s[e+1]=255-s[e+1]);a.putImageData(o,0,0);let c=e.clone();return c.source=new Cd(i),c}async decompressTextureAsync(e,t=1/0){if(this.textureUtils===null)throw Error(`THREE.GLTFExporter: setTextureUtils() must be called to process compressed textures.`);return await this.textureUtils.decompress(e,t)}processBuffer(e){let t=this.json,n=this.buffers;return t.buffers||=[{byteLength:0}],n.push(e),0}processBufferView(e,t,n,r,i){let a=this.json;a.bufferViews||=[];let o;switch(t){case Cx.BYTE:case Cx.UNSIGNED_BYTE:o=1;break;case Cx.SHORT:case Cx.UNSIGNED_SHORT:o=2;break;default:o=4}let s=e.itemSize*o;i===Cx.ARRAY_BUFFER&&(s=Math.ceil(s/4)*4);let c=Rx(r*s),l=new DataView(new ArrayBuffer(c)),u=0;for(let i=n;i<n+r;i++){for(let n=0;n<e.itemSize;n++){let r;e.itemSize>4?r=e.array[i*e.itemSize+n]:(n===0?r=e.getX(i):n===1?r=e.getY(i):n===2?r=e.getZ(i):n===3&&(r=e.getW(i)),e.normalized===!0&&(r=cd.normalize(r,e.array))),t===Cx.FLOAT?l.setFloat32(u,r,!0):t===Cx.INT?l.setInt32(u,r,!0):t===Cx.UNSIGNED_INT?l.setUint32(u,r,!0):t===Cx.SHORT?l.setInt16(u,r,!0):t===Cx.UNSIGNED_SHORT?l.setUint16(u,r,!0):t===Cx.BYTE?l.setInt8(u,r):t===Cx.UNSIGNED_BYTE&&l.setUint8(u,r),u+=o}u%s!==0&&(u+=s-u%s)}let d={buffer:this.processBuffer(l.buffer),byteOffset:this.byteOffset,byteLength:c};return i!==void 0&&(d.target=i),i===Cx.ARRAY_BUFFER&&(d.byteStride=s),this.byteOffset+=c,a.bufferViews.push(d),{id:a.bufferViews.length-1,byteLength:0}}processBufferViewImage(e){let t=this,n=t.json;return n.bufferViews||=[],new Promise(function(r){let i=new FileReader;i.readAsArrayBuffer(e),i.onloadend=function(){let e=zx(i.result),a={buffer:t.processBuffer(e),byteOffset:t.byteOffset,byteLength:e.byteLength};t.byteOffset+=e.byteLength,r(n.bufferViews.push(a)-1)}})}processAccessor(e,t,n,r){let i=this.json,a={1:`SCALAR`,2:`VEC2`,3:`VEC3`,4:`VEC4`,9:`MAT3`,16:`MAT4`},o;if(e.array.constructor===Float32Array)o=Cx.FLOAT;else if(e.array.constructor===Int32Array)o=Cx.INT;else if(e.array.constructor===Uint32Array)o=Cx.UNSIGNED_INT;else if(e.array.constructor===Int16Array)o=Cx.SHORT;else if(e.array.constructor===Uint16Array)o=Cx.UNSIGNED_SHORT;else if(e.array.constructor===Int8Array)o=Cx.BYTE;else if(e.array.constructor===Uint8Array)o=Cx.UNSIGNED_BYTE;else throw Error(`THREE.GLTFExporter: Unsupported bufferAttribute component type: `+e.array.constructor.name);if(n===void 0&&(n=0),(r===void 0||r===1/0)&&(r=e.count),r===0)return null;let s=Lx(e,n,r),c;t!==void 0&&(c=e===t.index?Cx.ELEMENT_ARRAY_BUFFER:Cx.ARRAY_BUFFER);let l=this.processBufferView(e,o,n,r,c),u={bufferView:l.id,byteOffset:l.byteOffset,componentType:o,count:r,max:s.max,min:s.min,type:a[e.itemSize]};return e.normalized===!0&&(u.normalized=!0),i.accessors||=[],i.accessors.push(u)-1}processImage(e,t,n,r=`image/png`){if(e!==null){let i=this,a=i.cache,o=i.json,s=i.options,c=i.pending;a.images.has(e)||a.images.set(e,{});let l=a.images.get(e),u=r+`:flipY/`+n.toString();if(l[u]!==void 0)return l[u];o.images||=[];let d={mimeType:r},f=Bx();f.width=Math.min(e.width,s.maxTextureSize),f.height=Math.min(e.height,s.maxTextureSize);let p=f.getContext(`2d`,{willReadFrequently:!0});if(n===!0&&(p.translate(0,f.height),p.scale(1,-1)),e.data!==void 0){t!==1023&&console.error(`GLTFExporter: Only RGBAFormat is supported.`,t),(e.width>s.maxTextureSize||e.height>s.maxTextureSize)&&console.warn(`GLTFExporter: Image size is bigger than maxTextureSize`,e);let n=new Uint8ClampedArray(e.height*e.width*4);for(let t=0;t<n.length;t+=4)n[t+0]=e.data[t+0],n[t+1]=e.data[t+1],n[t+2]=e.data[t+2],n[t+3]=e.data[t+3];p.putImageData(new ImageData(n,e.width,e.height),0,0)}else if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap||typeof OffscreenCanvas<`u`&&e instanceof OffscreenCanvas)p.drawImage(e,0,0,f.width,f.height);else throw Error(`THREE.GLTFExporter: Invalid image type. Use HTMLImageElement, HTMLCanvasElement, ImageBitmap or OffscreenCanvas.`);s.binary===!0?c.push(Vx(f,r).then(e=>i.processBufferViewImage(e)).then(e=>{d.bufferView=e})):d.uri=xd.getDataURL(f,r);let m=o.images.push(d)-1;return l[u]=m,m}throw Error(`THREE.GLTFExporter: No valid image data found. Unable to process texture.`)}processSampler(e){let t=this.json;t.samplers||=[];let n={magFilter:Tx[e.magFilter],minFilter:Tx[e.minFilter],wrapS:Tx[e.wrapS],wrapT:Tx[e.wrapT]};return t.samplers.push(n)-1}async processTextureAsync(e){let t=this.options,n=this.cache,r=this.json;if(n.textures.has(e))return n.textures.get(e);r.textures||=[],e instanceof hm&&(e=await this.decompressTextureAsync(e,t.maxTextureSize));let i=e.userData.mimeType,a=this.processImage(e.image,e.format,e.flipY,i),o={sampler:this.processSampler(e)};i===`image/webp`?(o.extensions=o.extensions||{},o.extensions.EXT_texture_webp={source:a},this.extensionsUsed.EXT_texture_webp=!0,this.extensionsRequired.EXT_texture_webp=!0):o.source=a,e.name&&(o.name=e.name),await this._invokeAllAsync(async function(t){t.writeTexture&&await t.writeTexture(e,o)});let s=r.textures.push(o)-1;return n.textures.set(e,s),s}async processMaterialAsync(e,t){let n=this.cache,r=this.json,i=t!==void 0&&t.hasAttribute(`tangent`),a=e.normalMap?e.uuid+`:`+i:e.uuid;if(n.materials.has(a))return n.materials.get(a);if(e.isShaderMaterial)return console.warn(`GLTFExporter: THREE.ShaderMaterial not supported.`),null;r.materials||=[];let o={pbrMetallicRoughness:{}};e.isMeshStandardMaterial!==!0&&e.isMeshBasicMaterial!==!0&&console.warn(`GLTFExporter: Use MeshStandardMaterial or MeshBasicMaterial for best results.`);let s=e.color.toArray().concat([e.opacity]);if(Px(s,[1,1,1,1])||(o.pbrMetallicRoughness.baseColorFactor=s),e.isMeshStandardMaterial?(o.pbrMetallicRoughness.metallicFactor=e.metalness,o.pbrMetallicRoughness.roughnessFactor=e.roughness):(o.pbrMetallicRoughness.metallicFactor=0,o.pbrMetallicRoughness.roughnessFactor=1),e.metalnessMap||e.roughnessMap){let t=await this.buildMetalRoughTextureAsync(e.metalnessMap,e.roughnessMap),n={index:await this.processTextureAsync(t),texCoord:t.channel};this.applyTextureTransform(n,t),o.pbrMetallicRoughness.metallicRoughnessTexture=n}if(e.map){let t={index:await this.processTextureAsync(e.map),texCoord:e.map.channel};this.applyTextureTransform(t,e.map),o.pbrMetallicRoughness.baseColorTexture=t}if(e.emissive){let t=e.emissive;if(Math.max(t.r,t.g,t.b)>0&&(o.emissiveFactor=e.emissive.toArray()),e.emissiveMap){let t={index:await this.processTextureAsync(e.emissiveMap),texCoord:e.emissiveMap.channel};this.applyTextureTransform(t,e.emissiveMap),o.emissiveTexture=t}}if(e.normalMap){let t=e.normalScale,r=t.x<0,a=i?t.y<0:t.y>0,s=e.normalMap;if(r||a){n.normalMaps.has(e.normalMap)===!1&&n.normalMaps.set(e.normalMap,{});let t=n.normalMaps.get(e.normalMap),i=`${r}:${a}`;t[i]===void 0&&(t[i]=await this.buildNormalMapTextureAsync(e.normalMap,r,a)),s=t[i]}let c={index:await this.processTextureAsync(s),texCoord:e.normalMap.channel};Math.abs(t.x)!==1&&(c.scale=Math.abs(t.x)),this.applyTextureTransform(c,e.normalMap),o.normalTexture=c}if(e.aoMap){let t={index:await this.processTextureAsync(e.aoMap),texCoord:e.aoMap.channel};e.aoMapIntensity!==1&&(t.strength=e.aoMapIntensity),this.applyTextureTransform(t,e.aoMap),o.occlusionTexture=t}e.transparent?o.alphaMode=`BLEND`:e.alphaTest>0&&(o.alphaMode=`MASK`,o.alphaCutoff=e.alphaTest),e.side===2&&(o.doubleSided=!0),e.name!==``&&(o.name=e.name),this.serializeUserData(e,o),await this._invokeAllAsync(async function(t){t.writeMaterialAsync&&await t.writeMaterialAsync(e,o)});let c=r.materials.push(o)-1;return n.materials.set(a,c),c}async processMeshAsync(e){let t=this.cache,n=this.json,r=[e.geometry.uuid];if(Array.isArray(e.material))for(let t=0,n=e.material.length;t<n;t++)r.push(e.material[t].uuid);else r.push(e.material.uuid);let i=r.join(`:`);if(t.meshes.has(i))return t.meshes.get(i);let a=e.geometry,o;o=e.isLineSegments?Cx.LINES:e.isLineLoop?Cx.LINE_LOOP:e.isLine?Cx.LINE_STRIP:e.isPoints?Cx.POINTS:e.material.wireframe?Cx.LINES:Cx.TRIANGLES;let s={},c={},l=[],u=[],d={uv:`TEXCOORD_0`,uv1:`TEXCOORD_1`,uv2:`TEXCOORD_2`,uv3:`TEXCOORD_3`,color:`COLOR_0`,skinWeight:`WEIGHTS_0`,skinIndex:`JOINTS_0`},f=a.getAttribute(`normal`);f!==void 0&&!this.isNormalizedNormalAttribute(f)&&(console.warn(`THREE.GLTFExporter: Creating normalized normal attribute from the non-normalized one.`),a.setAttribute(`normal`,this.createNormalizedNormalAttribute(f)));let p=null;for(let e in a.attributes){if(e.slice(0,5)===`morph`)continue;let n=a.attributes[e];if(e=d[e]||e.toUpperCase(),!/^(POSITION|NORMAL|TANGENT|TEXCOORD_\d+|COLOR_\d+|JOINTS_\d+|WEIGHTS_\d+)$/.test(e)&&!e.startsWith(`_`)&&(e=`_`+e),t.attributes.has(this.getUID(n))){c[e]=t.attributes.get(this.getUID(n));continue}p=null;let r=n.array;e===`JOINTS_0`&&!(r instanceof Uint16Array)&&!(r instanceof Uint8Array)?(console.warn(`GLTFExporter: Attribute "skinIndex" converted to type UNSIGNED_SHORT.`),p=Sx.Utils.toTypedBufferAttribute(n,Uint16Array)):(r instanceof Uint32Array||r instanceof Int32Array)&&!e.startsWith(`_`)&&(console.warn(`GLTFExporter: Attribute "${e}" converted to type FLOAT.`),p=Sx.Utils.toTypedBufferAttribute(n,Float32Array));let i=this.processAccessor(p||n,a);i!==null&&(e.startsWith(`_`)||this.detectMeshQuantization(e,n),c[e]=i,t.attributes.set(this.getUID(n),i))}if(f!==void 0&&a.setAttribute(`normal`,f),Object.keys(c).length===0)return null;if(e.morphTargetInfluences!==void 0&&e.morphTargetInfluences.length>0){let n=[],r=[],i={};if(e.morphTargetDictionary!==void 0)for(let t in e.morphTargetDictionary)i[e.morphTargetDictionary[t]]=t;for(let o=0;o<e.morphTargetInfluences.length;++o){let s={},c=!1;for(let e in a.morphAttributes){if(e!==`position`&&e!==`normal`){c||=(console.warn(`GLTFExporter: Only POSITION and NORMAL morph are supported.`),!0);continue}let n=a.morphAttributes[e][o],r=e.toUpperCase(),i=a.attributes[e];if(t.attributes.has(this.getUID(n,!0))){s[r]=t.attributes.get(this.getUID(n,!0));continue}let l=n.clone();if(!a.morphTargetsRelative)for(let e=0,t=n.count;e<t;e++)for(let t=0;t<n.itemSize;t++)t===0&&l.setX(e,n.getX(e)-i.getX(e)),t===1&&l.setY(e,n.getY(e)-i.getY(e)),t===2&&l.setZ(e,n.getZ(e)-i.getZ(e)),t===3&&l.setW(e,n.getW(e)-i.getW(e));s[r]=this.processAccessor(l,a),t.attributes.set(this.getUID(i,!0),s[r])}u.push(s),n.push(e.morphTargetInfluences[o]),e.morphTargetDictionary!==void 0&&r.push(i[o])}s.weights=n,r.length>0&&(s.extras={},s.extras.targetNames=r)}let m=Array.isArray(e.material);if(m&&a.groups.length===0)return null;let h=!1;if(m&&a.index===null){let e=[];for(let t=0,n=a.attributes.position.count;t<n;t++)e[t]=t;a.setIndex(e),h=!0}let g=m?e.material:[e.material],_=m?a.groups:[{materialIndex:0,start:void 0,count:void 0}];for(let e=0,n=_.length;e<n;e++){let n={mode:o,attributes:c};if(this.serializeUserData(a,n),u.length>0&&(n.targets=u),a.index!==null){let r=this.getUID(a.index);(_[e].start!==void 0||_[e].count!==void 0)&&(r+=`:`+_[e].start+`:`+_[e].count),t.attributes.has(r)?n.indices=t.attributes.get(r):(n.indices=this.processAccessor(a.index,a,_[e].start,_[e].count),t.attributes.set(r,n.indices)),n.indices===null&&delete n.indices}let r=await this.processMaterialAsync(g[_[e].materialIndex],a);r!==null&&(n.material=r),l.push(n)}h===!0&&a.setIndex(null),s.primitives=l,n.meshes||=[],await this._invokeAllAsync(function(t){t.writeMesh&&t.writeMesh(e,s)});let v=n.meshes.push(s)-1;return t.meshes.set(i,v),v}detectMeshQuantization(e,t){if(this.extensionsUsed[wx])return;let n;switch(t.array.constructor){case Int8Array:n=`byte`;break;case Uint8Array:n=`unsigned byte`;break;case Int16Array:n=`short`;break;case Uint16Array:n=`unsigned short`;break;default:return}t.normalized&&(n+=` normalized`);let r=e.split(`_`,1)[0];xx[r]&&xx[r].includes(n)&&(this.extensionsUsed[wx]=!0,this.extensionsRequired[wx]=!0)}processCamera(e){let t=this.json;t.cameras||=[];let n=e.isOrthographicCamera,r={type:n?`orthographic`:`perspective`};return n?r.orthographic={xmag:e.right,ymag:e.top,zfar:e.far<=0?.001:e.far,znear:e.near<0?0:e.near}:r.perspective={aspectRatio:e.aspect,yfov:cd.degToRad(e.fov),zfar:e.far<=0?.001:e.far,znear:e.near<0?0:e.near},e.name!==``&&(r.name=e.type),t.cameras.push(r)-1}processAnimation(e,t){let n=this.json,r=this.nodeMap;n.animations||=[],e=Sx.Utils.mergeMorphTargetTracks(e.clone(),t);let i=e.tracks,a=[],o=[];for(let e=0;e<i.length;++e){let n=i[e],s=C_.parseTrackName(n.name),c=C_.findNode(t,s.nodeName),l=Ex[s.propertyName];if(s.objectName===`bones`&&(c=c.isSkinnedMesh===!0?c.skeleton.getBoneByName(s.objectIndex):void 0),!c||!l){console.warn(`THREE.GLTFExporter: Could not export animation track "%s".`,n.name);continue}let u=n.values.length/n.times.length;l===Ex.morphTargetInfluences&&(u/=c.morphTargetInfluences.length);let d;n.createInterpolant.isInterpolantFactoryMethodGLTFCubicSpline===!0?(d=`CUBICSPLINE`,u/=3):d=n.getInterpolation()===2300?`STEP`:`LINEAR`,o.push({input:this.processAccessor(new Yf(n.times,1)),output:this.processAccessor(new Yf(n.values,u)),interpolation:d}),a.push({sampler:o.length-1,target:{node:r.get(c),path:l}})}let s={name:e.name||`clip_`+n.animations.length,samplers:o,channels:a};return this.serializeUserData(e,s),n.animations.push(s),n.animations.length-1}processSkin(e){let t=this.json,n=this.nodeMap,r=t.nodes[n.get(e)],i=e.skeleton;if(i===void 0)return null;let a=e.skeleton.bones[0];if(a===void 0)return null;let o=[],s=new Float32Array(i.bones.length*16),c=new Nd;for(let t=0;t<i.bones.length;++t)o.push(n.get(i.bones[t])),c.copy(i.boneInverses[t]),c.multiply(e.bindMatrix).toArray(s,t*16);return t.skins===void 0&&(t.skins=[]),t.skins.push({inverseBindMatrices:this.processAccessor(new Yf(s,16)),joints:o,skeleton:n.get(a)}),r.skin=t.skins.length-1}async processNodeAsync(e){let t=this.json,n=this.options,r=this.nodeMap;if(t.nodes||=[],e.pivot!==null)return await this._processNodeWithPivotAsync(e);let i={};if(n.trs){let t=e.quaternion.toArray(),n=e.position.toArray(),r=e.scale.toArray();Px(t,[0,0,0,1])||(i.rotation=t),Px(n,[0,0,0])||(i.translation=n),Px(r,[1,1,1])||(i.scale=r)}else e.matrixAutoUpdate&&e.updateMatrix(),Ix(e.matrix)===!1&&(i.matrix=e.matrix.elements);if(e.name!==``&&(i.name=String(e.name)),this.serializeUserData(e,i),e.isMesh||e.isLine||e.isPoints){let t=await this.processMeshAsync(e);t!==null&&(i.mesh=t)}else e.isCamera&&(i.camera=this.processCamera(e));e.isSkinnedMesh&&this.skins.push(e);let a=t.nodes.push(i)-1;if(r.set(e,a),e.children.length>0){let t=[];for(let r=0,i=e.children.length;r<i;r++){let i=e.children[r];if(i.visible||n.onlyVisible===!1){let e=await this.processNodeAsync(i);e!==null&&t.push(e)}}t.length>0&&(i.children=t)}return await this._invokeAllAsync(function(t){t.writeNode&&t.writeNode(e,i)}),a}async _processNodeWithPivotAsync(e){let t=this.json,n=this.options,r=this.nodeMap,i=e.pivot,a={},o=e.quaternion.toArray(),s=[e.position.x+i.x,e.position.y+i.y,e.position.z+i.z],c=e.scale.toArray();Px(o,[0,0,0,1])||(a.rotation=o),Px(s,[0,0,0])||(a.translation=s),Px(c,[1,1,1])||(a.scale=c),a.extras={pivot:i.toArray()},e.name!==``&&(a.name=String(e.name)),this.serializeUserData(e,a);let l=t.nodes.push(a)-1;r.set(e,l);let u={},d=[-i.x,-i.y,-i.z];if(Px(d,[0,0,0])||(u.translation=d),e.isMesh||e.isLine||e.isPoints){let t=await this.processMeshAsync(e);t!==null&&(u.mesh=t)}else e.isCamera&&(u.camera=this.processCamera(e));e.isSkinnedMesh&&this.skins.push(e);let f=[t.nodes.push(u)-1];if(e.children.length>0){let t=[];for(let r=0,i=e.children.length;r<i;r++){let i=e.children[r];if(i.visible||n.onlyVisible===!1){let e=await this.processNodeAsync(i);e!==null&&t.push(e)}}t.length>0&&(u.children=t)}return a.children=f,await this._invokeAllAsync(function(t){t.writeNode&&t.writeNode(e,a)}),l}async processSceneAsync(e){let t=this.json,n=this.options;t.scenes||(t.scenes=[],t.scene=0);let r={};e.name!==``&&(r.name=e.name),t.scenes.push(r);let i=[];for(let t=0,r=e.children.length;t<r;t++){let r=e.children[t];if(r.visible||n.onlyVisible===!1){let e=await this.processNodeAsync(r);e!==null&&i.push(e)}}i.length>0&&(r.nodes=i),this.serializeUserData(e,r)}async processObjectsAsync(e){let t=new gf;t.name=`AuxScene`;for(let n=0;n<e.length;n++)t.children.push(e[n]);await this.processSceneAsync(t)}async processInputAsync(e){let t=this.options;e=e instanceof Array?e:[e],await this._invokeAllAsync(function(t){t.beforeParse&&t.beforeParse(e)});let n=[];for(let t=0;t<e.length;t++)e[t]instanceof gf?await this.processSceneAsync(e[t]):n.push(e[t]);n.length>0&&await this.processObjectsAsync(n);for(let e=0;e<this.skins.length;++e)this.processSkin(this.skins[e]);if(e.length===1)for(let n=0;n<t.animations.length;++n)this.processAnimation(t.animations[n],e[0]);else for(let n=0;n<e.length;n++){let r=t.animations[n]||[];for(let t=0;t<r.length;++t)this.processAnimation(r[t],e[n])}await this._invokeAllAsync(function(t){t.afterParse&&t.afterParse(e)})}async _invokeAllAsync(e){for(let t=0,n=this.plugins.length;t<n;t++)await e(this.plugins[t])}},Ux=class{constructor(e){this.writer=e,this.name=`KHR_lights_punctual`}writeNode(e,t){if(!e.isLight)return;if(!e.isDirectionalLight&&!e.isPointLight&&!e.isSpotLight){console.warn(`THREE.GLTFExporter: Only directional, point, and spot lights are supported.`,e);return}let n=this.writer,r=n.json,i=n.extensionsUsed,a={};e.name&&(a.name=e.name),a.color=e.color.toArray(),a.intensity=e.intensity,e.isDirectionalLight?a.type=`directional`:e.isPointLight?(a.type=`point`,e.distance>0&&(a.range=e.distance)):e.isSpotLight&&(a.type=`spot`,e.distance>0&&(a.range=e.distance),a.spot={},a.spot.innerConeAngle=(1-e.penumbra)*e.angle,a.spot.outerConeAngle=e.angle),e.decay!==void 0&&e.decay!==2&&console.warn(`THREE.GLTFExporter: Light decay may be lost. glTF is physically-based, and expects light.decay=2.`),e.target&&(e.target.parent!==e||e.target.position.x!==0||e.target.position.y!==0||e.target.position.z!==-1)&&console.warn(`THREE.GLTFExporter: Light direction may be lost. For best results, make light.target a child of the light with position 0,0,-1.`),i[this.name]||(r.extensions=r.extensions||{},r.extensions[this.name]={lights:[]},i[this.name]=!0);let o=r.extensions[this.name].lights;o.push(a),t.extensions=t.extensions||{},t.extensions[this.name]={light:o.length-1}}},Wx=class{constructor(e){this.writer=e,this.name=`KHR_materials_unlit`}async writeMaterialAsync(e,t){if(!e.isMeshBasicMaterial)return;let n=this.writer.extensionsUsed;t.extensions=t.extensions||{},t.extensions[this.name]={},n[this.name]=!0,t.pbrMetallicRoughness.metallicFactor=0,t.pbrMetallicRoughness.roughnessFactor=.9}},Gx=class{constructor(e){this.writer=e,this.name=`KHR_materials_clearcoat`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.clearcoat===0)return;let n=this.writer,r=n.extensionsUsed,i={};if(i.clearcoatFactor=e.clearcoat,e.clearcoatMap){let t={index:await n.processTextureAsync(e.clearcoatMap),texCoord:e.clearcoatMap.channel};n.applyTextureTransform(t,e.clearcoatMap),i.clearcoatTexture=t}if(i.clearcoatRoughnessFactor=e.clearcoatRoughness,e.clearcoatRoughnessMap){let t={index:await n.processTextureAsync(e.clearcoatRoughnessMap),texCoord:e.clearcoatRoughnessMap.channel};n.applyTextureTransform(t,e.clearcoatRoughnessMap),i.clearcoatRoughnessTexture=t}if(e.clearcoatNormalMap){let t={index:await n.processTextureAsync(e.clearcoatNormalMap),texCoord:e.clearcoatNormalMap.channel};e.clearcoatNormalScale.x!==1&&(t.scale=e.clearcoatNormalScale.x),n.applyTextureTransform(t,e.clearcoatNormalMap),i.clearcoatNormalTexture=t}t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},Kx=class{constructor(e){this.writer=e,this.name=`KHR_materials_dispersion`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.dispersion===0)return;let n=this.writer.extensionsUsed,r={};r.dispersion=e.dispersion,t.extensions=t.extensions||{},t.extensions[this.name]=r,n[this.name]=!0}},qx=class{constructor(e){this.writer=e,this.name=`KHR_materials_iridescence`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.iridescence===0)return;let n=this.writer,r=n.extensionsUsed,i={};if(i.iridescenceFactor=e.iridescence,e.iridescenceMap){let t={index:await n.processTextureAsync(e.iridescenceMap),texCoord:e.iridescenceMap.channel};n.applyTextureTransform(t,e.iridescenceMap),i.iridescenceTexture=t}if(i.iridescenceIor=e.iridescenceIOR,i.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum,i.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum,e.iridescenceThicknessMap){let t={index:await n.processTextureAsync(e.iridescenceThicknessMap),texCoord:e.iridescenceThicknessMap.channel};n.applyTextureTransform(t,e.iridescenceThicknessMap),i.iridescenceThicknessTexture=t}t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},Jx=class{constructor(e){this.writer=e,this.name=`KHR_materials_transmission`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.transmission===0)return;let n=this.writer,r=n.extensionsUsed,i={};if(i.transmissionFactor=e.transmission,e.transmissionMap){let t={index:await n.processTextureAsync(e.transmissionMap),texCoord:e.transmissionMap.channel};n.applyTextureTransform(t,e.transmissionMap),i.transmissionTexture=t}t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},Yx=class{constructor(e){this.writer=e,this.name=`KHR_materials_volume`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.transmission===0)return;let n=this.writer,r=n.extensionsUsed,i={};if(i.thicknessFactor=e.thickness,e.thicknessMap){let t={index:await n.processTextureAsync(e.thicknessMap),texCoord:e.thicknessMap.channel};n.applyTextureTransform(t,e.thicknessMap),i.thicknessTexture=t}e.attenuationDistance!==1/0&&(i.attenuationDistance=e.attenuationDistance),i.attenuationColor=e.attenuationColor.toArray(),t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},Xx=class{constructor(e){this.writer=e,this.name=`KHR_materials_ior`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.ior===1.5)return;let n=this.writer.extensionsUsed,r={};r.ior=e.ior,t.extensions=t.extensions||{},t.extensions[this.name]=r,n[this.name]=!0}},Zx=class{constructor(e){this.writer=e,this.name=`KHR_materials_specular`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.specularIntensity===1&&e.specularColor.equals(Dx)&&!e.specularIntensityMap&&!e.specularColorMap)return;let n=this.writer,r=n.extensionsUsed,i={};if(e.specularIntensityMap){let t={index:await n.processTextureAsync(e.specularIntensityMap),texCoord:e.specularIntensityMap.channel};n.applyTextureTransform(t,e.specularIntensityMap),i.specularTexture=t}if(e.specularColorMap){let t={index:await n.processTextureAsync(e.specularColorMap),texCoord:e.specularColorMap.channel};n.applyTextureTransform(t,e.specularColorMap),i.specularColorTexture=t}i.specularFactor=e.specularIntensity,i.specularColorFactor=e.specularColor.toArray(),t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},Qx=class{constructor(e){this.writer=e,this.name=`KHR_materials_sheen`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.sheen==0)return;let n=this.writer,r=n.extensionsUsed,i={};if(e.sheenRoughnessMap){let t={index:await n.processTextureAsync(e.sheenRoughnessMap),texCoord:e.sheenRoughnessMap.channel};n.applyTextureTransform(t,e.sheenRoughnessMap),i.sheenRoughnessTexture=t}if(e.sheenColorMap){let t={index:await n.processTextureAsync(e.sheenColorMap),texCoord:e.sheenColorMap.channel};n.applyTextureTransform(t,e.sheenColorMap),i.sheenColorTexture=t}i.sheenRoughnessFactor=e.sheenRoughness,i.sheenColorFactor=e.sheenColor.toArray(),t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},$x=class{constructor(e){this.writer=e,this.name=`KHR_materials_anisotropy`}async writeMaterialAsync(e,t){if(!e.isMeshPhysicalMaterial||e.anisotropy==0)return;let n=this.writer,r=n.extensionsUsed,i={};if(e.anisotropyMap){let t={index:await n.processTextureAsync(e.anisotropyMap)};n.applyTextureTransform(t,e.anisotropyMap),i.anisotropyTexture=t}i.anisotropyStrength=e.anisotropy,i.anisotropyRotation=e.anisotropyRotation,t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},eS=class{constructor(e){this.writer=e,this.name=`KHR_materials_emissive_strength`}async writeMaterialAsync(e,t){if(!e.isMeshStandardMaterial||e.emissiveIntensity===1)return;let n=this.writer.extensionsUsed,r={};r.emissiveStrength=e.emissiveIntensity,t.extensions=t.extensions||{},t.extensions[this.name]=r,n[this.name]=!0}},tS=class{constructor(e){this.writer=e,this.name=`EXT_materials_bump`}async writeMaterialAsync(e,t){if(!e.isMeshStandardMaterial||e.bumpScale===1&&!e.bumpMap)return;let n=this.writer,r=n.extensionsUsed,i={};if(e.bumpMap){let t={index:await n.processTextureAsync(e.bumpMap),texCoord:e.bumpMap.channel};n.applyTextureTransform(t,e.bumpMap),i.bumpTexture=t}i.bumpFactor=e.bumpScale,t.extensions=t.extensions||{},t.extensions[this.name]=i,r[this.name]=!0}},nS=class{constructor(e){this.writer=e,this.name=`EXT_mesh_gpu_instancing`}writeNode(e,t){if(!e.isInstancedMesh)return;let n=this.writer,r=e,i=new Float32Array(r.count*3),a=new Float32Array(r.count*4),o=new Float32Array(r.count*3),s=new Nd,c=new X,l=new ld,u=new X;for(let e=0;e<r.count;e++)r.getMatrixAt(e,s),s.decompose(c,l,u),c.toArray(i,e*3),l.toArray(a,e*4),u.toArray(o,e*3);let d={TRANSLATION:n.processAccessor(new Yf(i,3)),ROTATION:n.processAccessor(new Yf(a,4)),SCALE:n.processAccessor(new Yf(o,3))};r.instanceColor&&(d._COLOR_0=n.processAccessor(r.instanceColor)),t.extensions=t.extensions||{},t.extensions[this.name]={attributes:d},n.extensionsUsed[this.name]=!0,n.extensionsRequired[this.name]=!0}};Sx.Utils={insertKeyframe:function(e,t){let n=.001,r=e.getValueSize(),i=new e.TimeBufferType(e.times.length+1),a=new e.ValueBufferType(e.values.length+r),o=e.createInterpolant(new e.ValueBufferType(r)),s;if(e.times.length===0){i[0]=t;for(let e=0;e<r;e++)a[e]=0;s=0}else if(t<e.times[0]){if(Math.abs(e.times[0]-t)<n)return 0;i[0]=t,i.set(e.times,1),a.set(o.evaluate(t),0),a.set(e.values,r),s=0}else if(t>e.times[e.times.length-1]){if(Math.abs(e.times[e.times.length-1]-t)<n)return e.times.length-1;i[i.length-1]=t,i.set(e.times,0),a.set(e.values,0),a.set(o.evaluate(t),e.values.length),s=i.length-1}else for(let c=0;c<e.times.length;c++){if(Math.abs(e.times[c]-t)<n)return c;if(e.times[c]<t&&e.times[c+1]>t){i.set(e.times.slice(0,c+1),0),i[c+1]=t,i.set(e.times.slice(c+1),c+2),a.set(e.values.slice(0,(c+1)*r),0),a.set(o.evaluate(t),(c+1)*r),a.set(e.values.slice((c+1)*r),(c+2)*r),s=c+1;break}}return e.times=i,e.values=a,s},mergeMorphTargetTracks:function(e,t){let n=[],r={},i=e.tracks;for(let e=0;e<i.length;++e){let a=i[e],o=C_.parseTrackName(a.name),s=C_.findNode(t,o.nodeName);if(o.propertyName!==`morphTargetInfluences`||o.propertyIndex===void 0){n.push(a);continue}if(a.createInterpolant!==a.InterpolantFactoryMethodDiscrete&&a.createInterpolant!==a.InterpolantFactoryMethodLinear){if(a.createInterpolant.isInterpolantFactoryMethodGLTFCubicSpline)throw Error(`THREE.GLTFExporter: Cannot merge tracks with glTF CUBICSPLINE interpolation.`);console.warn(`THREE.GLTFExporter: Morph target interpolation mode not yet supported. Using LINEAR instead.`),a=a.clone(),a.setInterpolation(uu)}let c=s.morphTargetInfluences.length,l=s.morphTargetDictionary[o.propertyIndex];if(l===void 0)throw Error(`THREE.GLTFExporter: Morph target name not found: `+o.propertyIndex);let u;if(r[s.uuid]===void 0){u=a.clone();let e=new u.ValueBufferType(c*u.times.length);for(let t=0;t<u.times.length;t++)e[t*c+l]=u.values[t];u.name=(o.nodeName||``)+`.morphTargetInfluences`,u.values=e,r[s.uuid]=u,n.push(u);continue}let d=a.createInterpolant(new a.ValueBufferType(1));u=r[s.uuid];for(let e=0;e<u.times.length;e++)u.values[e*c+l]=d.evaluate(u.times[e]);for(let e=0;e<a.times.length;e++){let t=this.insertKeyframe(u,a.times[e]);u.values[t*c+l]=a.values[e]}}return e.tracks=n,e},toTypedBufferAttribute:function(e,t){let n=new Yf(new t(e.count*e.itemSize),e.itemSize,!1);if(!e.normalized&&!e.isInterleavedBufferAttribute)return n.array.set(e.array),n;for(let t=0,r=e.count;t<r;t++)for(let r=0;r<e.itemSize;r++)n.setComponent(t,r,e.getComponent(t,r));return n}};var rS={mm:.001,cm:.01,m:1,in:.0254,ft:.3048};async function iS(e,t,n){let{scene:r,clip:i}=aS(e,t,n),a=await new Sx().parseAsync(r,{binary:!0,animations:[i],onlyVisible:!1});return new Blob([a],{type:`model/gltf-binary`})}function aS(e,t,n){let{report:r}=e,i=new Map,a=t.filter(({overlay:e})=>!e),o=r.bodies.map(({name:e})=>oS(new cf,e)),s=new cf,c=[];for(let{body:e,object:t,part:n}of a){let r=sS(t,i,c);(e===void 0?s:o[e]).add(oS(r,n.name))}let l=new Vg(`motion`,-1,mS(e,a,o,c,n)),u=oS(new cf().add(...o,s),r.title);return u.rotation.x=-Math.PI/2,u.scale.setScalar(rS[r.units.length]??1),{scene:new cf().add(u),clip:l}}function oS(e,t){return e.name=t,e}function sS(e,t,n){let r=lS(e,t);r.position.copy(e.position),r.quaternion.copy(e.quaternion),r.scale.copy(e.scale),n.push([e,r]);for(let i of e.children)cS(i)||r.add(sS(i,t,n));return r}function cS(e){return e instanceof mm}function lS(e,t){if(`isLineSegments2`in e)return uS(e);if(!(e instanceof Lp))return new cf;let n=[e.material].flat()[0],r=t.get(n)??dS(n);return t.set(n,r),new Lp(e.geometry,r)}function uS({geometry:e,material:t}){let{instanceStart:n,instanceEnd:r}=e.attributes,i=[];for(let e=0;e<n.count;e++)i.push(n.getX(e),n.getY(e),n.getZ(e),r.getX(e),r.getY(e),r.getZ(e));return new mm(new lp().setAttribute(`position`,new Q(i,3)),new Tp({color:t.color}))}function dS(e){let{color:t,map:n}=e,{opacity:r,transparent:i,side:a}=e;return new mg({color:t??new Z,map:n??null,metalness:0,roughness:1,opacity:r,transparent:i,side:a})}var fS=class{#e=[];#t=[];#n=[];#r=[];add(e,{position:t,quaternion:n,scale:r}){Number.isFinite(t.x+t.y+t.z+n.w+r.x+r.y+r.z)&&(this.#e.push(e),this.#t.push(...t.toArray()),this.#n.push(...n.toArray()),this.#r.push(...r.toArray()))}tracks({uuid:e}){let t=this.#e;return[...pS(this.#t,3)?[new Bg(`${e}.position`,t,this.#t)]:[],...pS(this.#n,4)?[new Rg(`${e}.quaternion`,t,this.#n)]:[],...pS(this.#r,3)?[new Bg(`${e}.scale`,t,this.#r)]:[]]}};function pS(e,t){return e.some((n,r)=>n!==e[r%t])}function mS(e,t,n,r,i){let{times:a}=e.report,o=t.filter(({follow:e})=>e),s=n.map(()=>new fS),c=new Set(o.flatMap(({object:e})=>hS(e))),l=r.filter(([e])=>c.has(e)).map(e=>({pair:e,path:new fS})),u=t=>{let r=e.frame(t);for(let{follow:e}of o)e(r);return n.forEach((n,r)=>{let i=e.poseAt(r,t);i&&(n.position.copy(i.place),n.quaternion.copy(i.turn))}),r};for(let e=0;e<a.length;e++){let t=u(e),r=a[e]-a[0];s.forEach((e,i)=>t.visible(i)&&e.add(r,n[i]));for(let{pair:e,path:t}of l)t.add(r,e[0])}u(i);for(let{pair:[e,t]}of l)t.position.copy(e.position),t.quaternion.copy(e.quaternion),t.scale.copy(e.scale);return[...s.flatMap((e,t)=>e.tracks(n[t])),...l.flatMap(({pair:e,path:t})=>t.tracks(e[1]))]}function hS(e){let t=[];return e.traverse(e=>t.push(e)),t}var gS=new jf,_S=new X,vS=class extends s_{constructor(){super(),this.isLineSegmentsGeometry=!0,this.type=`LineSegmentsGeometry`,this.setIndex([0,2,1,2,3,1,2,4,3,4,5,3,4,6,5,6,7,5]),this.setAttribute(`position`,new Q([-1,2,0,1,2,0,-1,1,0,1,1,0,-1,0,0,1,0,0,-1,-1,0,1,-1,0],3)),this.setAttribute(`uv`,new Q([-1,2,1,2,-1,1,1,1,-1,-1,1,-1,-1,-2,1,-2],2))}applyMatrix4(e){let t=this.attributes.instanceStart,n=this.attributes.instanceEnd;return t!==void 0&&(t.applyMatrix4(e),n.applyMatrix4(e),t.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this}setPositions(e){let t;e instanceof Float32Array?t=e:Array.isArray(e)&&(t=new Float32Array(e));let n=new w_(t,6,1);return this.setAttribute(`instanceStart`,new pp(n,3,0)),this.setAttribute(`instanceEnd`,new pp(n,3,3)),this.instanceCount=this.attributes.instanceStart.count,this.computeBoundingBox(),this.computeBoundingSphere(),this}setColors(e){let t;e instanceof Float32Array?t=e:Array.isArray(e)&&(t=new Float32Array(e));let n=new w_(t,6,1);return this.setAttribute(`instanceColorStart`,new pp(n,3,0)),this.setAttribute(`instanceColorEnd`,new pp(n,3,3)),this}fromWireframeGeometry(e){return this.setPositions(e.attributes.position.array),this}fromEdgesGeometry(e){return this.setPositions(e.attributes.position.array),this}fromMesh(e){return this.fromWireframeGeometry(new tg(e.geometry)),this}fromLineSegments(e){let t=e.geometry;return this.setPositions(t.attributes.position.array),this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new jf);let e=this.attributes.instanceStart,t=this.attributes.instanceEnd;e!==void 0&&t!==void 0&&(this.boundingBox.setFromBufferAttribute(e),gS.setFromBufferAttribute(t),this.boundingBox.union(gS))}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new tp),this.boundingBox===null&&this.computeBoundingBox();let e=this.attributes.instanceStart,t=this.attributes.instanceEnd;if(e!==void 0&&t!==void 0){let n=this.boundingSphere.center;this.boundingBox.getCenter(n);let r=0;for(let i=0,a=e.count;i<a;i++)_S.fromBufferAttribute(e,i),r=Math.max(r,n.distanceToSquared(_S)),_S.fromBufferAttribute(t,i),r=Math.max(r,n.distanceToSquared(_S));this.boundingSphere.radius=Math.sqrt(r),isNaN(this.boundingSphere.radius)&&console.error(`THREE.LineSegmentsGeometry.computeBoundingSphere(): Computed radius is NaN. The instanced position data is likely to have NaN values.`,this)}}toJSON(){}};$.line={worldUnits:{value:1},linewidth:{value:1},resolution:{value:new Y},dashOffset:{value:0},dashScale:{value:1},dashSize:{value:1},gapSize:{value:1}},W_.line={uniforms:lg.merge([$.common,$.fog,$.line]),vertexShader:`
		#include <common>
		#include <color_pars_vertex>
		#include <fog_pars_vertex>
		#include <logdepthbuf_pars_vertex>
		#include <clipping_planes_pars_vertex>

		uniform float linewidth;
		uniform vec2 resolution;

		attribute vec3 instanceStart;
		attribute vec3 instanceEnd;

		attribute vec3 instanceColorStart;
		attribute vec3 instanceColorEnd;

		#ifdef WORLD_UNITS

			varying vec4 worldPos;
			varying vec3 worldStart;
			varying vec3 worldEnd;

			#ifdef USE_DASH

				varying vec2 vUv;

			#endif

		#else

			varying vec2 vUv;

		#endif

		#ifdef USE_DASH

			uniform float dashScale;
			attribute float instanceDistanceStart;
			attribute float instanceDistanceEnd;
			varying float vLineDistance;

		#endif

		float trimSegmentAlpha( const in vec4 start, const in vec4 end ) {

			// compute the interpolation factor needed to trim the segment so it terminates
			// between the camera plane and the near plane

			// conservative estimate of the near plane
			float a = projectionMatrix[ 2 ][ 2 ]; // 3nd entry in 3th column
			float b = projectionMatrix[ 3 ][ 2 ]; // 3nd entry in 4th column

			// we need different nearEstimate formula for reversed and default depth buffer
			// a is positive with a reversed depth buffer so it can be used for controlling the code flow
			float nearEstimate = ( a > 0.0 ) ? ( - b / ( a + 1.0 ) ) : ( - 0.5 * b / a );

			return ( nearEstimate - start.z ) / ( end.z - start.z );

		}

		void main() {

			#ifdef USE_COLOR

				vColor.xyz = ( position.y < 0.5 ) ? instanceColorStart : instanceColorEnd;

			#endif

			float aspect = resolution.x / resolution.y;

			// camera space
			vec4 start = modelViewMatrix * vec4( instanceStart, 1.0 );
			vec4 end = modelViewMatrix * vec4( instanceEnd, 1.0 );

			#ifdef USE_DASH

				float lineDistanceStart = dashScale * instanceDistanceStart;
				float lineDistanceEnd = dashScale * instanceDistanceEnd;

			#endif

			#ifdef WORLD_UNITS

				worldStart = start.xyz;
				worldEnd = end.xyz;

			#else

				vUv = uv;

			#endif

			// special case for perspective projection, and segments that terminate either in, or behind, the camera plane
			// clearly the gpu firmware has a way of addressing this issue when projecting into ndc space
			// but we need to perform ndc-space calculations in the shader, so we must address this issue directly
			// perhaps there is a more elegant solution -- WestLangley

			bool perspective = ( projectionMatrix[ 2 ][ 3 ] == - 1.0 ); // 4th entry in the 3rd column

			if ( perspective ) {

				if ( start.z < 0.0 && end.z >= 0.0 ) {

					float alpha = trimSegmentAlpha( start, end );
					end.xyz = mix( start.xyz, end.xyz, alpha );

					#ifdef USE_DASH

						lineDistanceEnd = mix( lineDistanceStart, lineDistanceEnd, alpha );

					#endif

				} else if ( end.z < 0.0 && start.z >= 0.0 ) {

					float alpha = trimSegmentAlpha( end, start );
					start.xyz = mix( end.xyz, start.xyz, alpha );

					#ifdef USE_DASH

						lineDistanceStart = mix( lineDistanceEnd, lineDistanceStart, alpha );

					#endif

				}

			}

			#ifdef USE_DASH

				vLineDistance = ( position.y < 0.5 ) ? lineDistanceStart : lineDistanceEnd;
				vUv = uv;

			#endif

			// clip space
			vec4 clipStart = projectionMatrix * start;
			vec4 clipEnd = projectionMatrix * end;

			// ndc space
			vec3 ndcStart = clipStart.xyz / clipStart.w;
			vec3 ndcEnd = clipEnd.xyz / clipEnd.w;

			// direction
			vec2 dir = ndcEnd.xy - ndcStart.xy;

			// account for clip-space aspect ratio
			dir.x *= aspect;
			dir = normalize( dir );

			#ifdef WORLD_UNITS

				vec3 worldDir = normalize( end.xyz - start.xyz );
				vec3 tmpFwd = perspective ? normalize( mix( start.xyz, end.xyz, 0.5 ) ) : vec3( 0.0, 0.0, - 1.0 );
				vec3 worldUp = normalize( cross( worldDir, tmpFwd ) );
				vec3 worldFwd = cross( worldDir, worldUp );
				worldPos = position.y < 0.5 ? start: end;

				// height offset
				float hw = linewidth * 0.5;
				worldPos.xyz += position.x < 0.0 ? hw * worldUp : - hw * worldUp;

				// don't extend the line if we're rendering dashes because we
				// won't be rendering the endcaps
				#ifndef USE_DASH

					// cap extension
					worldPos.xyz += position.y < 0.5 ? - hw * worldDir : hw * worldDir;

					// add width to the box
					worldPos.xyz += worldFwd * hw;

					// endcaps
					if ( position.y > 1.0 || position.y < 0.0 ) {

						worldPos.xyz -= worldFwd * 2.0 * hw;

					}

				#endif

				// project the worldpos
				vec4 clip = projectionMatrix * worldPos;

				// shift the depth of the projected points so the line
				// segments overlap neatly
				vec3 clipPose = ( position.y < 0.5 ) ? ndcStart : ndcEnd;

				// only shift the depth of vertices in front of the camera (#35137)
				if ( clip.w > 0.0 ) clip.z = clipPose.z * clip.w;

			#else

				vec2 offset = vec2( dir.y, - dir.x );
				// undo aspect ratio adjustment
				dir.x /= aspect;
				offset.x /= aspect;

				// sign flip
				if ( position.x < 0.0 ) offset *= - 1.0;

				// endcaps
				if ( position.y < 0.0 ) {

					offset += - dir;

				} else if ( position.y > 1.0 ) {

					offset += dir;

				}

				// adjust for linewidth
				offset *= linewidth;

				// adjust for clip-space to screen-space conversion // maybe resolution should be based on viewport ...
				offset /= resolution.y;

				// select end
				vec4 clip = ( position.y < 0.5 ) ? clipStart : clipEnd;

				// back to clip space
				offset *= clip.w;

				clip.xy += offset;

			#endif

			gl_Position = clip;

			vec4 mvPosition = ( position.y < 0.5 ) ? start : end; // this is an approximation

			#include <logdepthbuf_vertex>
			#include <clipping_planes_vertex>
			#include <fog_vertex>

		}
		`,fragmentShader:`
		uniform vec3 diffuse;
		uniform float opacity;
		uniform float linewidth;

		#ifdef USE_DASH

			uniform float dashOffset;
			uniform float dashSize;
			uniform float gapSize;

		#endif

		varying float vLineDistance;

		#ifdef WORLD_UNITS

			varying vec4 worldPos;
			varying vec3 worldStart;
			varying vec3 worldEnd;

			#ifdef USE_DASH

				varying vec2 vUv;

			#endif

		#else

			varying vec2 vUv;

		#endif

		#include <common>
		#include <color_pars_fragment>
		#include <fog_pars_fragment>
		#include <logdepthbuf_pars_fragment>
		#include <clipping_planes_pars_fragment>

		vec2 closestLineToLine(vec3 p1, vec3 p2, vec3 p3, vec3 p4) {

			float mua;
			float mub;

			vec3 p13 = p1 - p3;
			vec3 p43 = p4 - p3;

			vec3 p21 = p2 - p1;

			float d1343 = dot( p13, p43 );
			float d4321 = dot( p43, p21 );
			float d1321 = dot( p13, p21 );
			float d4343 = dot( p43, p43 );
			float d2121 = dot( p21, p21 );

			float denom = d2121 * d4343 - d4321 * d4321;

			float numer = d1343 * d4321 - d1321 * d4343;

			mua = numer / denom;
			mua = clamp( mua, 0.0, 1.0 );
			mub = ( d1343 + d4321 * ( mua ) ) / d4343;
			mub = clamp( mub, 0.0, 1.0 );

			return vec2( mua, mub );

		}

		void main() {

			float alpha = opacity;
			vec4 diffuseColor = vec4( diffuse, alpha );

			#include <clipping_planes_fragment>

			#ifdef USE_DASH

				if ( vUv.y < - 1.0 || vUv.y > 1.0 ) discard; // discard endcaps

				if ( mod( vLineDistance + dashOffset, dashSize + gapSize ) > dashSize ) discard; // todo - FIX

			#endif

			#ifdef WORLD_UNITS

				float len;

				if ( isOrthographic ) {

					// View rays are parallel to the z axis so the distance reduces to camera-space XY
					vec2 lineDir = worldEnd.xy - worldStart.xy;
					float t = clamp( dot( worldPos.xy - worldStart.xy, lineDir ) / dot( lineDir, lineDir ), 0.0, 1.0 );
					len = length( worldStart.xy + lineDir * t - worldPos.xy );

				} else {

					// Find the closest points on the view ray and the line segment
					vec3 rayEnd = normalize( worldPos.xyz ) * 1e5;
					vec3 lineDir = worldEnd - worldStart;
					vec2 params = closestLineToLine( worldStart, worldEnd, vec3( 0.0, 0.0, 0.0 ), rayEnd );

					vec3 p1 = worldStart + lineDir * params.x;
					vec3 p2 = rayEnd * params.y;
					vec3 delta = p1 - p2;
					len = length( delta );

				}

				float norm = len / linewidth;

				#ifndef USE_DASH

					#ifdef USE_ALPHA_TO_COVERAGE

						float dnorm = fwidth( norm );
						alpha = 1.0 - smoothstep( 0.5 - dnorm, 0.5 + dnorm, norm );

					#else

						if ( norm > 0.5 ) {

							discard;

						}

					#endif

				#endif

			#else

				#ifdef USE_ALPHA_TO_COVERAGE

					// artifacts appear on some hardware if a derivative is taken within a conditional
					float a = vUv.x;
					float b = ( vUv.y > 0.0 ) ? vUv.y - 1.0 : vUv.y + 1.0;
					float len2 = a * a + b * b;
					float dlen = fwidth( len2 );

					if ( abs( vUv.y ) > 1.0 ) {

						alpha = 1.0 - smoothstep( 1.0 - dlen, 1.0 + dlen, len2 );

					}

				#else

					if ( abs( vUv.y ) > 1.0 ) {

						float a = vUv.x;
						float b = ( vUv.y > 0.0 ) ? vUv.y - 1.0 : vUv.y + 1.0;
						float len2 = a * a + b * b;

						if ( len2 > 1.0 ) discard;

					}

				#endif

			#endif

			#include <logdepthbuf_fragment>
			#include <color_fragment>

			gl_FragColor = vec4( diffuseColor.rgb, alpha );

			#include <tonemapping_fragment>
			#include <colorspace_fragment>
			#include <fog_fragment>
			#include <premultiplied_alpha_fragment>

		}
		`};var yS=class extends fg{constructor(e){super({type:`LineMaterial`,uniforms:lg.clone(W_.line.uniforms),vertexShader:W_.line.vertexShader,fragmentShader:W_.line.fragmentShader,clipping:!0}),this.isLineMaterial=!0,this.setValues(e)}get color(){return this.uniforms.diffuse.value}set color(e){this.uniforms.diffuse.value=e}get worldUnits(){return`WORLD_UNITS`in this.defines}set worldUnits(e){e===!0!==this.worldUnits&&(this.needsUpdate=!0),e===!0?this.defines.WORLD_UNITS=``:delete this.defines.WORLD_UNITS}get linewidth(){return this.uniforms.linewidth.value}set linewidth(e){this.uniforms.linewidth&&(this.uniforms.linewidth.value=e)}get dashed(){return`USE_DASH`in this.defines}set dashed(e){e===!0!==this.dashed&&(this.needsUpdate=!0),e===!0?this.defines.USE_DASH=``:delete this.defines.USE_DASH}get dashScale(){return this.uniforms.dashScale.value}set dashScale(e){this.uniforms.dashScale.value=e}get dashSize(){return this.uniforms.dashSize.value}set dashSize(e){this.uniforms.dashSize.value=e}get dashOffset(){return this.uniforms.dashOffset.value}set dashOffset(e){this.uniforms.dashOffset.value=e}get gapSize(){return this.uniforms.gapSize.value}set gapSize(e){this.uniforms.gapSize.value=e}get opacity(){return this.uniforms.opacity.value}set opacity(e){this.uniforms&&(this.uniforms.opacity.value=e)}get resolution(){return this.uniforms.resolution.value}set resolution(e){this.uniforms.resolution.value.copy(e)}get alphaToCoverage(){return`USE_ALPHA_TO_COVERAGE`in this.defines}set alphaToCoverage(e){this.defines&&(e===!0!==this.alphaToCoverage&&(this.needsUpdate=!0),e===!0?this.defines.USE_ALPHA_TO_COVERAGE=``:delete this.defines.USE_ALPHA_TO_COVERAGE)}},bS=new Od,xS=new X,SS=new X,CS=new Od,wS=new Od,TS=new Od,ES=new X,DS=new Nd,OS=new L_,kS=new X,AS=new jf,jS=new tp,MS=new Od,NS,PS;function FS(e,t,n){return MS.set(0,0,-t,1).applyMatrix4(e.projectionMatrix),MS.multiplyScalar(1/MS.w),MS.x=PS/n.width,MS.y=PS/n.height,MS.applyMatrix4(e.projectionMatrixInverse),MS.multiplyScalar(1/MS.w),Math.abs(Math.max(MS.x,MS.y))}function IS(e,t){let n=e.matrixWorld,r=e.geometry,i=r.attributes.instanceStart,a=r.attributes.instanceEnd,o=Math.min(r.instanceCount,i.count);for(let r=0,s=o;r<s;r++){OS.start.fromBufferAttribute(i,r),OS.end.fromBufferAttribute(a,r),OS.applyMatrix4(n);let o=new X,s=new X;NS.distanceSqToSegment(OS.start,OS.end,s,o),s.distanceTo(o)<PS*.5&&t.push({point:s,pointOnLine:o,distance:NS.origin.distanceTo(s),object:e,face:null,faceIndex:r,uv:null,uv1:null})}}function LS(e,t,n){let r=t.projectionMatrix,i=e.material.resolution,a=e.matrixWorld,o=e.geometry,s=o.attributes.instanceStart,c=o.attributes.instanceEnd,l=Math.min(o.instanceCount,s.count),u=-t.near;NS.at(1,TS),TS.w=1,TS.applyMatrix4(t.matrixWorldInverse),TS.applyMatrix4(r),TS.multiplyScalar(1/TS.w),TS.x*=i.x/2,TS.y*=i.y/2,TS.z=0,ES.copy(TS),DS.multiplyMatrices(t.matrixWorldInverse,a);for(let t=0,o=l;t<o;t++){if(CS.fromBufferAttribute(s,t),wS.fromBufferAttribute(c,t),CS.w=1,wS.w=1,CS.applyMatrix4(DS),wS.applyMatrix4(DS),CS.z>u&&wS.z>u)continue;if(CS.z>u){let e=CS.z-wS.z,t=(CS.z-u)/e;CS.lerp(wS,t)}else if(wS.z>u){let e=wS.z-CS.z,t=(wS.z-u)/e;wS.lerp(CS,t)}CS.applyMatrix4(r),wS.applyMatrix4(r),CS.multiplyScalar(1/CS.w),wS.multiplyScalar(1/wS.w),CS.x*=i.x/2,CS.y*=i.y/2,wS.x*=i.x/2,wS.y*=i.y/2,OS.start.copy(CS),OS.start.z=0,OS.end.copy(wS),OS.end.z=0;let o=OS.closestPointToPointParameter(ES,!0);OS.at(o,kS);let l=cd.lerp(CS.z,wS.z,o),d=l>=-1&&l<=1,f=ES.distanceTo(kS)<PS*.5;if(d&&f){OS.start.fromBufferAttribute(s,t),OS.end.fromBufferAttribute(c,t),OS.start.applyMatrix4(a),OS.end.applyMatrix4(a);let r=new X,i=new X;NS.distanceSqToSegment(OS.start,OS.end,i,r),n.push({point:i,pointOnLine:r,distance:NS.origin.distanceTo(i),object:e,face:null,faceIndex:t,uv:null,uv1:null})}}}var RS=class extends Lp{constructor(e=new vS,t=new yS({color:Math.random()*16777215})){super(e,t),this.isLineSegments2=!0,this.type=`LineSegments2`}computeLineDistances(){let e=this.geometry,t=e.attributes.instanceStart,n=e.attributes.instanceEnd,r=new Float32Array(2*t.count);for(let e=0,i=0,a=t.count;e<a;e++,i+=2)xS.fromBufferAttribute(t,e),SS.fromBufferAttribute(n,e),r[i]=i===0?0:r[i-1],r[i+1]=r[i]+xS.distanceTo(SS);let i=new w_(r,2,1);return e.setAttribute(`instanceDistanceStart`,new pp(i,1,0)),e.setAttribute(`instanceDistanceEnd`,new pp(i,1,1)),this}raycast(e,t){let n=this.material.worldUnits,r=e.camera;if(r===null&&!n&&console.error(`LineSegments2: "Raycaster.camera" needs to be set in order to raycast against LineSegments2 while worldUnits is set to false.`),n===!1&&(this.material.resolution.x===0||this.material.resolution.y===0))return;let i=e.params.Line2===void 0?0:e.params.Line2.threshold||0;NS=e.ray;let a=this.matrixWorld,o=this.geometry,s=this.material;PS=s.linewidth+i,o.boundingSphere===null&&o.computeBoundingSphere(),jS.copy(o.boundingSphere).applyMatrix4(a);let c;if(c=n?PS*.5:FS(r,Math.max(r.near,jS.distanceToPoint(NS.origin)),s.resolution),jS.radius+=c,NS.intersectsSphere(jS)===!1)return;o.boundingBox===null&&o.computeBoundingBox(),AS.copy(o.boundingBox).applyMatrix4(a);let l;l=n?PS*.5:FS(r,Math.max(r.near,AS.distanceToPoint(NS.origin)),s.resolution),AS.expandByScalar(l),NS.intersectsBox(AS)!==!1&&(n?IS(this,t):LS(this,r,t))}onBeforeRender(e){let t=this.material.uniforms;t&&t.resolution&&(e.getViewport(bS),this.material.uniforms.resolution.value.set(bS.z,bS.w))}},zS=.03,BS=Math.cos(40*Math.PI/180),VS=1e-5,HS=new X(-.35,.7,.75).normalize(),US=.62,WS=12,GS=.9;function KS(e,t,n){let{width:r,height:i,view:a,label:o,labels:s=[]}=n,c=[];for(let r of e)r.updateWorldMatrix(!0,!0),r.traverseVisible(e=>c.push(...JS(e,t,n)));return c.sort((e,t)=>e.layer-t.layer||t.depth-e.depth),mc(r,i,n.title,fc(`rect`,{width:r,height:i,fill:a}),`<g stroke-linejoin="round" stroke-linecap="round">${qS(c)}</g>`,fc(`g`,{"font-family":`system-ui, sans-serif`,"font-size":11,"text-anchor":`middle`},...s.map(({spot:e,x:t,y:n})=>fc(`line`,{x1:e.x,y1:e.y,x2:t,y2:n,stroke:o,"stroke-opacity":.6})),...s.map(e=>fc(`rect`,{x:e.x-e.width/2,y:e.y-e.height/2,width:e.width,height:e.height,rx:4,fill:a,"fill-opacity":.9})+fc(`text`,{x:e.x,y:e.y+4,fill:o},dc(e.spot.text)))))}function qS(e){let t=[],n=``;return e.forEach(({style:r,path:i},a)=>{n+=i,e[a+1]?.style!==r&&(t.push(`<path ${r} d="${n}"/>`),n=``)}),t.join(``)}function JS(e,t,n){if(e instanceof RS)return ZS(e,t,n);if(e instanceof mm||!(`isMesh`in e))return[];let r=e,i=[r.material].flat()[0];return`color`in i?r instanceof Yp?Array.from({length:r.count},(e,a)=>{let o=new Nd;return r.getMatrixAt(a,o),eC(r,i,o.premultiply(r.matrixWorld),t,n)}).flat():eC(r,i,r.matrixWorld,t,n):[]}function YS(e,t,{width:n,height:r}){let i=-e.clone().applyMatrix4(t.matrixWorldInverse).z,{x:a,y:o}=e.clone().project(t);return{x:(a+1)*n/2,y:(1-o)*r/2,depth:i}}function XS(e,{depthTest:t}){return t?0:1+e.renderOrder}function ZS(e,t,n){let{material:r}=e,{instanceStart:i,instanceEnd:a}=e.geometry.attributes,o=(t,n)=>new X(n.getX(t),n.getY(t),n.getZ(t)).applyMatrix4(e.matrixWorld),{linewidth:s,opacity:c,dashed:l}=r,u=l?` stroke-dasharray="${pc(4*s)} ${pc(3*s)}"`:``,d=`fill="none" stroke="${aC(r.color)}" stroke-width="${pc(s)}" stroke-opacity="${pc(c)}"${u}`,f=XS(e,r),p=[];for(let e=0;e<i.count;e++){let[r,s]=[o(e,i),o(e,a)],[c,l]=[r,s].map(e=>YS(e,t,n));if(rC(c)&&rC(l)){if(f>0){let e=p[p.length-1];e&&e.path.endsWith(`L${iC(c)}`)?e.path+=`L${iC(l)}`:p.push({layer:f,depth:0,style:d,path:`M${iC(c)}L${iC(l)}`})}else for(let[e,t]of QS(c,l,n))p.push({layer:f,depth:(e.depth+t.depth)/2*.9998,style:d,path:`M${iC(e)}L${iC(t)}`})}}return p}function QS(e,t,{width:n,height:r}){let i=Math.min(200,Math.max(1,Math.ceil(Math.hypot(t.x-e.x,t.y-e.y)/(zS*Math.hypot(n,r))))),a=n=>$S(e,t,n/i);return Array.from({length:i},(e,t)=>[a(t),a(t+1)])}function $S(e,t,n){let r=(e,t)=>e+n*(t-e);return{x:r(e.x,t.x),y:r(e.y,t.y),depth:r(e.depth,t.depth)}}function eC(e,t,n,r,i){let{corners:a,vertices:o}=sC(e.geometry),s=o.map(e=>e.clone().applyMatrix4(n)),c=s.map(e=>YS(e,r,i)),l=XS(e,t),u=t.opacity<1,d=!(`isMeshBasicMaterial`in t),{color:f,map:p}=t,m=p?i.ground:aC(f),h=[],g=new Map,_=n.determinant()<0;for(let e=0;e<a.length;e+=3){let[n,o,f]=_?[a[e],a[e+2],a[e+1]]:[a[e],a[e+1],a[e+2]],[p,v,y]=[c[n],c[o],c[f]];if(![p,v,y].every(rC))continue;let b=s[o].clone().sub(s[n]).cross(s[f].clone().sub(s[n])).normalize(),x=(v.x-p.x)*(y.y-p.y)-(v.y-p.y)*(y.x-p.x)<0,S=x||t.side!==0;for(let[e,t]of[[n,o],[o,f],[f,n]]){let n=e<t?`${e} ${t}`:`${t} ${e}`,r=g.get(n)??{a:e,b:t,faces:[]};g.set(n,r),r.faces.push({normal:b,seen:x})}if(!S)continue;let C=x?b:b.clone().negate(),w=d?oC(m,C.transformDirection(r.matrixWorldInverse).dot(HS)):m,T=u?`fill="${w}" fill-opacity="${pc(t.opacity)}"`:`fill="${w}" stroke="${w}" stroke-width="0.4"`;for(let e of tC([p,v,y],i))h.push({layer:l,depth:(e[0].depth+e[1].depth+e[2].depth)/3,style:T,path:`M${iC(e[0])}L${iC(e[1])}L${iC(e[2])}z`})}if(u||l>0)return h;let v=`fill="none" stroke="${i.outline}" stroke-width="${GS}"`;for(let{a:e,b:n,faces:[r,a]}of g.values())if((!a||r.seen!==a.seen||r.seen&&r.normal.dot(a.normal)<BS)&&(r.seen||a?.seen||t.side!==0))for(let[t,r]of QS(c[e],c[n],i))h.push({layer:l,depth:(t.depth+r.depth)/2*.9998,style:v,path:`M${iC(t)}L${iC(r)}`});return h}function tC(e,t){let n=zS*Math.hypot(t.width,t.height)*2,r=[],i=[e];for(;i.length>0;){let[e,t,a]=i.pop(),o=[nC(e,t),nC(t,a),nC(a,e)],s=Math.max(...o);if(s<n||r.length+i.length>400){r.push([e,t,a]);continue}let[c,l,u]=s===o[0]?[e,t,a]:s===o[1]?[t,a,e]:[a,e,t],d=$S(c,l,.5);i.push([c,d,u],[d,l,u])}return r}var nC=(e,t)=>Math.hypot(e.x-t.x,e.y-t.y),rC=({x:e,y:t,depth:n})=>n>0&&Number.isFinite(e+t),iC=({x:e,y:t})=>`${Math.round(e*10)/10} ${Math.round(t*10)/10}`,aC=e=>`#${e.getHexString()}`;function oC(e,t){let n=US+.38*(Math.round(WS*Math.min(1,Math.max(0,(t+1)/1.6)))/WS);return`#${[1,3,5].map(t=>Math.round(n*parseInt(e.slice(t,t+2),16))).map(e=>e.toString(16).padStart(2,`0`)).join(``)}`}function sC(e){let{position:t}=e.attributes;e.boundingSphere||e.computeBoundingSphere();let n=VS*(e.boundingSphere?.radius||1),r=new Map,i=[],a=Array.from({length:t.count},(e,a)=>{let o=new X().fromBufferAttribute(t,a),s=o.toArray().map(e=>Math.round(e/n)).join(` `),c=r.get(s)??i.push(o)-1;return r.set(s,c),c});return{corners:(e.index?Array.from(e.index.array):a.map((e,t)=>t)).map(e=>a[e]),vertices:i}}var cC=200,lC=Math.PI*(3-Math.sqrt(5)),uC=Array.from({length:cC},(e,t)=>{let n=1-(2*t+1)/cC,r=Math.sqrt(1-n*n);return new X(r*Math.cos(t*lC),r*Math.sin(t*lC),n)}),dC=new WeakMap;function fC(e){if(e.length<=cC)return e;let t=new Set;for(let{x:n,y:r,z:i}of uC){let[a,o]=[e[0],-1/0];for(let t of e){let e=t.x*n+t.y*r+t.z*i;e>o&&([a,o]=[t,e])}t.add(a)}return[...t]}function pC(e,t=new Nd){e.updateMatrix();let n=t.clone().multiply(e.matrix),r=e=>a.map(t=>t.clone().applyMatrix4(e)),{geometry:i}=e,a=i?mC(i):[];return[...(e instanceof Yp?hC(e).map(e=>e.premultiply(n)):[n]).flatMap(r),...e.children.filter(({visible:e})=>e).flatMap(e=>pC(e,n))]}function mC(e){let t=dC.get(e);if(t)return t;let{position:n,instanceStart:r,instanceEnd:i}=e.attributes,a=fC((r?[r,i]:n?[n]:[]).flatMap(e=>Array.from({length:e.count},(t,n)=>new X().fromBufferAttribute(e,n))).filter(({x:e,y:t,z:n})=>Number.isFinite(e+t+n)));return dC.set(e,a),a}function hC(e){return Array.from({length:e.count},(t,n)=>{let r=new Nd;return e.getMatrixAt(n,r),r})}var gC=class extends vS{constructor(){super(),this.isLineGeometry=!0,this.type=`LineGeometry`}setPositions(e){let t=e.length-3,n=new Float32Array(2*t);for(let r=0;r<t;r+=3)n[2*r]=e[r],n[2*r+1]=e[r+1],n[2*r+2]=e[r+2],n[2*r+3]=e[r+3],n[2*r+4]=e[r+4],n[2*r+5]=e[r+5];return super.setPositions(n),this}setColors(e){let t=e.length-3,n=new Float32Array(2*t);for(let r=0;r<t;r+=3)n[2*r]=e[r],n[2*r+1]=e[r+1],n[2*r+2]=e[r+2],n[2*r+3]=e[r+3],n[2*r+4]=e[r+4],n[2*r+5]=e[r+5];return super.setColors(n),this}setFromPoints(e){let t=e.length-1,n=new Float32Array(6*t);for(let r=0;r<t;r++)n[6*r]=e[r].x,n[6*r+1]=e[r].y,n[6*r+2]=e[r].z||0,n[6*r+3]=e[r+1].x,n[6*r+4]=e[r+1].y,n[6*r+5]=e[r+1].z||0;return super.setPositions(n),this}fromLine(e){let t=e.geometry;return this.setPositions(t.attributes.position.array),this}},_C=class extends RS{constructor(e=new gC,t=new yS({color:Math.random()*16777215})){super(e,t),this.isLine2=!0,this.type=`Line2`}},vC=class{origin;normal;x;y;constructor(e,t,n=yC(t)){this.origin=e,this.normal=t,this.x=n,this.normal=t.clone().normalize(),this.x=bC(n,this.normal),this.y=this.normal.clone().cross(this.x)}to(e){let t=e.clone().sub(this.origin);return[t.dot(this.x),t.dot(this.y)]}from([e,t],n=0){return this.origin.clone().addScaledVector(this.x,e).addScaledVector(this.y,t).addScaledVector(this.normal,n)}matrix(){return new Nd().makeBasis(this.x,this.y,this.normal).setPosition(this.origin)}};function yC(e){let t=e.clone().normalize();return bC(Math.abs(t.z)<.9?new X(0,0,1):new X(1,0,0),t)}function bC(e,t){let n=e.clone().addScaledVector(t,-e.dot(t));return n.length()>1e-6*e.length()?n.normalize():yC(t)}function xC(e){let t=e.slice().sort((e,t)=>e[0]-t[0]||e[1]-t[1]),n=(e,t,n)=>(t[0]-e[0])*(n[1]-e[1])-(t[1]-e[1])*(n[0]-e[0]),r=e=>{let t=[];for(let r of e){for(;t.length>1&&n(t[t.length-2],t[t.length-1],r)<=0;)t.pop();t.push(r)}return t.pop(),t};return t.length<3?t:[...r(t),...r(t.slice().reverse())]}var SC=40;function CC(e){return xC(e.flatMap(([e,t,n])=>Array.from({length:SC},(r,i)=>{let a=2*Math.PI*i/SC;return[e+n*Math.cos(a),t+n*Math.sin(a)]})))}function wC(e,t){let n=e;return e.forEach((r,i)=>{let a=e[(i+1)%e.length],o=Math.hypot(a[0]-r[0],a[1]-r[1]);if(o===0)return;let s=e=>((e[0]-r[0])*(r[1]-a[1])+(e[1]-r[1])*(a[0]-r[0]))/o-t;n=n.flatMap((e,t)=>{let r=n[(t+1)%n.length],[i,a]=[s(e),s(r)],o=i/(i-a);return[...i>=0?[e]:[],...i*a<0?[[e[0]+o*(r[0]-e[0]),e[1]+o*(r[1]-e[1])]]:[]]})}),n.length<3?[]:n}function TC(e){let t=e.reduce((t,n,r)=>{let i=e[(r+1)%e.length];return t+n[0]*i[1]-i[0]*n[1]},0);return Math.abs(t/2)}function EC(e,t){let n=[e[0],e[0]],r=-1;return e.forEach((i,a)=>{for(let o of e.slice(a+1)){let e=t(i,o);e>r&&([r,n]=[e,[i,o]])}}),n}var DC={on:1.4,off:1.1},OC=.55,kC=new X(0,1,0),AC=class{mechanism;palette;unit;#e=new Map;#t=[];#n=new Map;#r;constructor(e,t){this.mechanism=e,this.palette=t,this.unit=e.unit}body(e){let t=this.mechanism.colourOf(e);return t<0?this.palette.ground:this.palette.bodies[t]}solid(e,{opacity:t=1,open:n=!1,facets:r=!1}={}){return this.#c(`solid ${e} ${t} ${n} ${r}`,()=>{let i=t<1;return new hg({color:e,transparent:i,opacity:t,depthWrite:!i,side:i||n?2:0,flatShading:r,polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:1})})}flat(e,{over:t=!1,opacity:n=1}={}){return this.#c(`flat ${e} ${t} ${n}`,()=>new Tp({color:e,transparent:!0,opacity:n,depthTest:!t,depthWrite:!t}))}mesh(e,t,n={}){return this.#i(this.#u(e),t,n)}cylinder(e,t,n,r,i,a={}){let o=t.clone().sub(e),s=o.length(),c=n===r,l=c?this.#l(`rod`,()=>new Sm(1,1,1,20)):this.#u(new Sm(r,n,1,20)),u=this.#i(l,i,a);return c&&u.scale.set(n,1,n),u.scale.y=s,u.visible=s>0,jC(u,e.clone().addScaledVector(o,.5),s>0?o:kC)}ball(e,t,n,r={}){let i=this.#i(this.#l(`ball`,()=>new Qh(1,20,14)),n,r);return i.scale.setScalar(t),i.position.copy(e),i}disc(e,t,n,r,i,a={}){let o=this.#i(this.#l(`disc`,()=>new Sm(1,1,1,36)),i,a);return o.scale.set(n,r,n),jC(o,e,t)}tube(e,t,n,r,i,a,o={}){let s=i/2;return this.lathe(e,t,[[r,-s],[n,-s],[n,s],[r,s],[r,-s]],a,{open:!0,...o})}lathe(e,t,n,r,i={}){let a=this.#u(new qh(n.map(([e,t])=>new Y(e,t)),48));return jC(this.#i(a,r,i),e,t)}shadowOf({geometry:e,position:t,quaternion:n,scale:r}){let i=new Lp(e,this.#c(`shadow`,()=>new Tp({colorWrite:!1,depthWrite:!1,transparent:!0})));return i.position.copy(t),i.quaternion.copy(n),i.scale.copy(r),i.castShadow=!0,i.raycast=()=>{},i}brick(e,t,n,r,i,a={edges:30}){let o=t.clone().normalize(),s=bC(n,o),c=new xm(...r).applyMatrix4(new Nd().makeBasis(o,s,o.clone().cross(s)).setPosition(e));return this.mesh(c,i,a)}slab(e,t,n,r,i=[],a={}){let o=new oh(e.map(([e,t])=>new Y(e,t)));for(let e of i)o.holes.push(new ah(e.map(([e,t])=>new Y(e,t))));let s=new Wh(o,{depth:n,bevelEnabled:!1});return this.mesh(s.translate(0,0,-n/2).applyMatrix4(t.matrix()),r,a)}triangles(e,t,n={}){let r=new lp;return r.setAttribute(`position`,new Q(e.flatMap(e=>e.toArray()),3)),r.computeVertexNormals(),this.mesh(r,t,n)}line(e,t,n,r={}){let i=new _C(this.#u(new gC().setFromPoints(e)),this.#o(t,n,r));return r.dashed&&i.computeLineDistances(),i}lines(e,t,n,r={}){let i=new RS(this.#u(new vS().setPositions(e.flatMap(e=>e.toArray()))),this.#o(t,n,r));return r.dashed&&i.computeLineDistances(),i}hatchLine(e,t,n,r){let i=t.clone().sub(e),a=Math.max(3,Math.round(i.length()/(1.25*r))),o=i.divideScalar(a),s=n.clone().normalize().multiplyScalar(1.3*r),c=Array.from({length:a},(t,n)=>e.clone().addScaledVector(o,n+1));return new cf().add(this.line([e,t],this.palette.hatch,2),this.lines(c.flatMap(e=>[e,e.clone().addScaledVector(o,-.9).add(s)]),this.palette.hatch,1.2))}footPlate(e,t,n,r){let i=t.clone().normalize().negate();return this.hatched(e,bC(n??yC(i),i).cross(i),i,[r,.14*r,.8*r])}hatched(e,t,n,r){let i=new xm(...r),{uv:a,normal:o}=i.attributes,s=1/(2.5*this.unit);for(let e=0;e<a.count;e++){let[t,n]=[Math.abs(o.getX(e)),Math.abs(o.getY(e))],i=t>.5?r[2]:r[0],c=n>.5?r[2]:r[1];a.setXY(e,a.getX(e)*i*s,a.getY(e)*c*s)}let c=t.clone().normalize(),l=bC(n,c);i.applyMatrix4(new Nd().makeBasis(c,l,c.clone().cross(l)).setPosition(e));let u=this.mesh(i,this.palette.ground);return u.material=this.#c(`hatched`,()=>new hg({map:this.#s(),polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:1})),u}dispose(){for(let e of[...this.#e.values(),...this.#t,...this.#n.values()])e.dispose();this.#r?.dispose(),this.#e.clear(),this.#n.clear(),this.#t=[]}#i(e,t,n){let r=new Lp(e,this.solid(t,n));if(r.castShadow=(n.opacity??1)>=1,n.edges){let t=new mm(this.#u(new km(e,n.edges)),this.#a());t.raycast=()=>{},r.add(t)}return r}#a(){return this.#c(`edge`,()=>new nm({color:this.palette.outline,transparent:!0,opacity:OC}))}#o(e,t,{dashed:n=!1,opacity:r=1,over:i=!1}){return this.#c(`line ${e} ${t} ${n} ${r} ${i}`,()=>new yS({color:e,linewidth:t,dashed:n,dashSize:DC.on*this.unit,gapSize:DC.off*this.unit,transparent:r<1||i,opacity:r,depthTest:!i,depthWrite:!i}))}#s(){if(this.#r)return this.#r;let e=document.createElement(`canvas`),t=e.width=e.height=32,n=e.getContext(`2d`);n.fillStyle=this.palette.ground,n.fillRect(0,0,t,t),n.strokeStyle=this.palette.view,n.lineWidth=7;for(let e=-t;e<2*t;e+=t/2)n.beginPath(),n.moveTo(e,t+2),n.lineTo(e+t+4,-2),n.stroke();return this.#r=new _m(e),this.#r.wrapS=this.#r.wrapT=Yc,this.#r.colorSpace=vu,this.#r.anisotropy=4,this.#r}#c(e,t){let n=this.#e.get(e);if(n)return n;let r=t();return this.#e.set(e,r),r}#l(e,t){let n=this.#n.get(e);if(n)return n;let r=t();return this.#n.set(e,r),r}#u(e){return this.#t.push(e),e}};function jC(e,t,n){return e.position.copy(t),n&&e.quaternion.setFromUnitVectors(kC,n.clone().normalize()),e}function MC(e,t,n){let r=n.clone().sub(t),i=r.length();return e.visible=i>0,e.visible?(e.scale.y=i,jC(e,t.clone().addScaledVector(r,.5),r)):e}function NC(e,t,n,r){let i=n.clone().normalize(),a=bC(r,i);return e.position.copy(t),e.quaternion.copy(new ld().setFromRotationMatrix(new Nd().makeBasis(i.clone().cross(a),i,a))),e}var PC=1,FC={none:0,hovered:.5,chosen:1},IC=class{#e=new Ad(1,1,{minFilter:Qc,magFilter:Qc});#t=new fg({side:2,uniforms:{part:{value:new Od}},vertexShader:`void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.); }`,fragmentShader:`uniform vec4 part; void main() { gl_FragColor = part; }`});#n=new fg({transparent:!0,depthTest:!1,depthWrite:!1,uniforms:{parts:{value:this.#e.texture},texel:{value:new Y},pixel:{value:new Y},ink:{value:new Z},chosen:{value:new Z},emphasis:{value:0}},vertexShader:`varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0., 1.); }`,fragmentShader:LC});#r=new Lp(new Yh(2,2),this.#n);#i=new i_;#a=new Map;constructor(){this.#r.frustumCulled=!1}number(e,t){e.layers.enable(PC),e.onBeforeRender=(e,n,r,i,a)=>{if(a!==this.#t)return;let o=FC[this.#a.get(t)??`none`];this.#t.uniforms.part.value.set((t&255)/255,(t>>8)/255,o,1),this.#t.uniformsNeedUpdate=!0}}emphasise(e){this.#a=e,this.#n.uniforms.emphasis.value=+(e.size>0)}colour(e){this.#n.uniforms.ink.value.set(e.outline),this.#n.uniforms.chosen.value.set(e.chosen)}resize(e,t,n){let r=n<1.5?2:n;this.#e.setSize(Math.round(e*r),Math.round(t*r)),this.#n.uniforms.texel.value.set(1/this.#e.width,1/this.#e.height),this.#n.uniforms.pixel.value.set(1/e,1/t)}draw(e,t,n){let r=e.getClearColor(new Z),i=n.layers.mask;n.layers.set(PC),t.overrideMaterial=this.#t,e.setRenderTarget(this.#e),e.setClearColor(0,0),e.clear(),e.render(t,n),e.setRenderTarget(null),e.setClearColor(r,1),t.overrideMaterial=null,n.layers.mask=i,e.render(this.#r,this.#i)}dispose(){this.#e.dispose(),this.#t.dispose(),this.#n.dispose(),this.#r.geometry.dispose()}},LC=`
varying vec2 at;
uniform sampler2D parts;
uniform vec2 texel, pixel;
uniform vec3 ink, chosen;
uniform float emphasis;
float differ(vec4 a, vec4 b) { return step(.001, abs(a.r - b.r) + abs(a.g - b.g)); }
vec4 read(float x, float y) { return texture2D(parts, at + vec2(x, y) * .5 * pixel); }
void main() {
  vec4 a = read(-1., -1.), b = read(0., -1.), c = read(1., -1.);
  vec4 d = read(-1., 0.), e = read(0., 0.), f = read(1., 0.);
  vec4 g = read(-1., 1.), h = read(0., 1.), i = read(1., 1.);
  float across = differ(a, b) + differ(b, c) + differ(d, e) + differ(e, f) + differ(g, h) + differ(h, i);
  float along = differ(a, d) + differ(d, g) + differ(b, e) + differ(e, h) + differ(c, f) + differ(f, i);
  float line = .9 * min(1., max(across, along) / 3.);
  vec3 colour = ink;
  if (emphasis > .5) {
    float hovered = 0., selected = 0.;
    for (int k = 0; k < 12; k++) {
      float t = float(k) * .5236;
      float near = texture2D(parts, at + pixel * vec2(cos(t), sin(t))).b;
      float far = texture2D(parts, at + 1.5 * pixel * vec2(cos(t), sin(t))).b;
      hovered += step(.25, abs(near - e.b)) / 3.;
      selected += step(.25, abs(far - e.b)) * step(.75, max(far, e.b)) / 3.;
    }
    line = max(line, min(1., hovered));
    if (selected > 0.) { colour = mix(ink, chosen, min(1., selected)); line = max(line, min(1., selected)); }
  }
  if (line < .01) discard;
  gl_FragColor = vec4(colour, line);
  #include <colorspace_fragment>
}`,RC=1,zC=class{mechanism;groups;drawn;numbers=[];#e;#t;#n;constructor(e,t,n,r,i,a){this.mechanism=e,this.#e=new AC(e,t),this.drawn=r.flatMap(t=>t(e,this.#e,n)),this.groups=[...e.report.bodies,e].map(()=>new cf);let o=this.groups[this.groups.length-1],s=a;for(let{body:e,object:t,part:n,overlay:r}of this.drawn){t.userData.part=n,(e===void 0?o:this.groups[e]).add(t);let a=new Map;t.traverse(e=>{if(r)return e.layers.set(2);let{material:t,isMesh:o}=e;!o||Array.isArray(t)||t.transparent||!(`wireframe`in t)||`isLineSegments2`in e||(a.has(t)||(a.set(t,++s),this.numbers.push({part:n,number:s})),i.number(e,a.get(t)))})}}pose(e){this.#t=e,this.mechanism.report.bodies.forEach((t,n)=>{let r=this.groups[n];if(r.visible=e.visible(n),!r.visible)return;let i=this.mechanism.poseAt(n,e.step);r.position.copy(i.place),r.quaternion.copy(i.turn)});for(let{follow:t}of this.drawn)t?.(e)}refine(e){let t=!1;for(let{object:n,detail:r}of this.drawn){if(r===void 0)continue;let i=r*e>=RC;t||=i!==n.visible,n.visible=i}return t}get reach(){return this.#n??=this.#r()}dispose(){for(let e of this.groups)e.removeFromParent();this.#e.dispose()}#r(){let{mechanism:e,drawn:t}=this,n=this.groups.length-1,r=this.groups.map((e,r)=>fC(t.filter(({body:e=n,follow:t})=>e===r&&!t).flatMap(({object:e})=>pC(e)))),i=t.filter(({follow:e})=>e),a=e.moments.flatMap(t=>{let n=e.frame(t),a=(e,t)=>e===void 0?t:t.map(t=>n.at(e,t)),o=e.report.bodies.flatMap((e,n)=>n>0||t===0?a(n,r[n]):[]),s=i.flatMap(({body:e,object:t,follow:r})=>(r(n),t.visible?a(e,pC(t)):[]));return[...o,...s]});return this.#t&&this.pose(this.#t),[...r[n],...a].filter(({x:e,y:t,z:n})=>Number.isFinite(e+t+n))}},BC=22,VC=1.06,HC=34,UC=.2,WC=1e-4;function GC(e){let{plane:t,up:n,vehicle:r,report:i}=e;if(t){let e=n.clone().cross(t),r=t.clone().addScaledVector(n,.45).addScaledVector(e,.55);return[KC(`straight`,`seen straight on`,t.clone()),KC(`tilt`,`seen from the side and above`,r)]}if(r){let{forward:t}=r,a=n.clone().cross(t),o=(e,r,i)=>t.clone().multiplyScalar(e).addScaledVector(a,r).addScaledVector(n,i),s=i.wheels.map(({centre:t})=>e.worldAt(t.body,new X(...t.at),0).dot(a)),c=s.length===1&&Math.sign(s[0])||1;return[KC(`corner`,`seen from the front corner`,s.length>1?o(.95,-.62,.5):o(.85,-.8*c,.42)),KC(`front`,`seen from ahead`,o(1,0,WC)),KC(`side`,c>0?`seen from its left`:`seen from its right`,o(0,c,WC)),KC(`top`,`seen from above, ahead is up`,o(-1e-4,0,1)),KC(`rear`,`seen from behind`,o(-1,0,WC))]}return[KC(`corner`,`seen from the corner`,e.reader.clone()),KC(`front`,`seen along y`,new X(0,-1,WC)),KC(`side`,`seen against x`,new X(1,0,WC)),KC(`top`,`seen from above`,new X(0,-1e-4,1))]}var KC=(e,t,n)=>({name:e,title:t,direction:n.normalize()});function qC({plane:e,up:t,size:n}){let r=e?new i_:new r_(BC);return r.up.copy(t),r.near=n*.02,r.far=n*60,r}function JC(e,t,n,{direction:r},i,a,o=HC){e.position.copy(r),e.lookAt(0,0,0),e.updateMatrixWorld();let[s,c,l]=[0,1,2].map(t=>new X().setFromMatrixColumn(e.matrixWorld,t)),u=i/a,d=1-2*o/a,f=e=>t.reduce((t,n)=>Math.max(t,e(n.dot(s),n.dot(c),n.dot(l))),-1/0),p=f((e,t,n)=>n),m=(p-f((e,t,n)=>-n))/2,h=e instanceof r_?Math.tan(e.fov*Math.PI/360):0,[g,_,v]=[h*u/VC,h*d/VC,h/VC],[y,b]=[f((e,t,n)=>e+g*n),f((e,t,n)=>-e+g*n)],[x,S]=[f((e,t,n)=>t+_*n),f((e,t,n)=>-t+v*n)],C,w;if(e instanceof r_)w=Math.max((y+b)/(2*g),(x+S)/(_+v),p+UC*n),C=[(y-b)/2,(x-_*w+v*w-S)/2];else{let t=Math.max((x+S)/(1+d),(y+b)/2/u,.02*n)*VC;e.zoom=1,e.userData.half=t,w=m+4*n,C=[(y-b)/2,(x-S)/2+(1-d)/2*t]}let T=new X().addScaledVector(s,C[0]).addScaledVector(c,C[1]).addScaledVector(l,m);return e.position.copy(T).addScaledVector(l,w-m),XC(e,u),T}function YC(e,t,n){return e instanceof i_?n*e.zoom/(e.top-e.bottom):n/(2*Math.tan(e.fov*Math.PI/360)*e.position.distanceTo(t))}function XC(e,t){if(e instanceof r_)e.aspect=t;else{let n=e.userData.half??1;e.top=n,e.bottom=-n,e.left=-n*t,e.right=n*t}e.updateProjectionMatrix(),e.updateMatrixWorld()}function ZC({report:e},t){let n=e.joints.filter(({body_i:e,body_j:n})=>e===t||n===t).map(({name:e})=>e),r=t===0?`fixed`:`body`;return{kind:`body`,index:t,name:e.bodies[t].name,about:n.length>0?`${r}, joints ${ew(n)}`:r}}function QC({report:e},t){let{name:n,kind:r,body_i:i,body_j:a,cut:o}=e.joints[t],s=`${e.bodies[i].name} and ${e.bodies[a].name}`;return{kind:`joint`,index:t,name:n,about:`${r.replaceAll(`_`,` `)} joint of ${s}${o?`, closes a loop`:``}`}}var $C=6;function ew(e){return e.length>$C?`${e.slice(0,5).join(`, `)} and ${e.length-$C+1} more`:e.join(`, `)}var tw=1.9,nw=4.2,rw=[1.5,.9],iw=.08;function aw(e,t,n,r){let i=t.unit,a=t.body(n),[o,s]=r.map(({centre:e})=>new X(...e.at)),c=s.clone().sub(o),l=e.shapePoints(n).flatMap(e=>{let n=Math.min(.92,Math.max(iw,e.clone().sub(o).dot(c)/c.lengthSq())),r=o.clone().addScaledVector(c,n);return r.distanceTo(e)<2*i?[]:[t.cylinder(r,e,rw[0]*i,rw[1]*i,a),t.ball(e,1.1*rw[1]*i,a)]}),u=r.map(({centre:e,axis:n,radius:r})=>t.disc(new X(...e.at),new X(...n),.22*r,i,a));return[t.cylinder(o,s,tw*i,tw*i,a),t.ball(o.clone().addScaledVector(c,.5),nw*i,a),...l,...u]}var ow=1.55,sw=2.6,cw=3.2,lw=2.4,uw=.95,dw={block:1.5,pin:1.05},fw=.04,pw={inside:1.25,area:10,opacity:.34,thickness:.5},mw=[1.5,.9];function hw(e,t,n){let r=t.unit,{thickness:i}=e,a=t.body(n),{basis:o,points:s}=_w(e,n);if(s.length===0)return[];let c=(e,n=[])=>t.slab(e,o,i,a,n),l=e.report.joints.flatMap((t,n)=>{let r=e.slideOf(n);return r?[{joint:t,slide:r}]:[]});if(s.length===1)return l.some(({slide:e})=>e.block===n)?[]:[c(CC([[...s[0],lw*r]]))];let u=l.filter(({slide:e})=>e.rail===n&&e.low<=e.high).map(({joint:e,slide:t})=>{let n=(e.kind===`inplane`?dw.pin:dw.block)*r;return CC([t.low,t.high].map(e=>o.to(t.place.clone().addScaledVector(t.axis,e))).map(([e,t])=>[e,t,n]))}),d=(u.length>0?sw:e.carriers.has(n)?cw:ow)*r,f=xC(s),p=EC(s,vw),m=vw(...p);if(u.length>0||f.length<3||TC(f)<=fw*m*m){let e=(u.length>0||f.length<3?[]:s.filter(e=>!p.includes(e))).flatMap(e=>p.map(t=>c(CC([[...e,.9*d],[...t,.7*d]]))));return[c(CC(p.map(([e,t])=>[e,t,d])),u),...e]}let h=CC(f.map(([e,t])=>[e,t,d])),g=wC(f,pw.inside*r);if(g.length<3||TC(g)<pw.area*r*r)return[c(h)];let _=t.slab(g,o,pw.thickness*i,a,[],{opacity:pw.opacity}),v=s.filter(e=>!f.includes(e)).flatMap(e=>f.slice().sort((t,n)=>vw(t,e)-vw(n,e)).slice(0,2).map(t=>c(CC([[...e,mw[0]*r],[...t,mw[1]*r]]))));return[c(h,[g]),_,...v]}function gw(e,t,n){let{basis:r,points:i}=_w(e,n);if(i.length<2)return[];let a=xC(i),o=CC((a.length>2?a:EC(i,vw)).map(([e,n])=>[e,n,uw*t.unit]));return[t.slab(o,r,e.thickness,t.body(n))]}function _w(e,t){let n=e.shapePoints(t),r=e.into(t,e.plane),i=new vC((n[0]??r.clone().setScalar(0)).clone().add(e.lift(t)),r);return{basis:i,points:n.map(e=>i.to(e))}}var vw=(e,t)=>Math.hypot(e[0]-t[0],e[1]-t[1]),yw=0,bw=1,xw=new X,Sw=new L_,Cw=new _p,ww=new X,Tw=new Af,Ew=class{constructor(){this.tolerance=-1,this.faces=[],this.newFaces=[],this.assigned=new Aw,this.unassigned=new Aw,this.vertices=[]}setFromPoints(e){if(e.length>=4){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.vertices.push(new kw(e[t]));this._compute()}return this}setFromObject(e){let t=[];return e.updateMatrixWorld(!0),e.traverse(function(e){let n=e.geometry;if(n!==void 0){let r=n.attributes.position;if(r!==void 0)for(let n=0,i=r.count;n<i;n++){let i=new X;i.fromBufferAttribute(r,n).applyMatrix4(e.matrixWorld),t.push(i)}}}),this.setFromPoints(t)}containsPoint(e){let t=this.faces;for(let n=0,r=t.length;n<r;n++)if(t[n].distanceToPoint(e)>this.tolerance)return!1;return!0}intersectRay(e,t){let n=this.faces,r=-1/0,i=1/0;for(let t=0,a=n.length;t<a;t++){let a=n[t],o=a.distanceToPoint(e.origin),s=a.normal.dot(e.direction);if(o>0&&s>=0)return null;let c=s===0?0:-o/s;if(!(c<=0)&&(s>0?i=Math.min(c,i):r=Math.max(c,r),r>i))return null}return r===-1/0?e.at(i,t):e.at(r,t),t}intersectsRay(e){return this.intersectRay(e,xw)!==null}makeEmpty(){return this.faces=[],this.vertices=[],this}_addVertexToFace(e,t){return e.face=t,t.outside===null?this.assigned.append(e):this.assigned.insertBefore(t.outside,e),t.outside=e,this}_removeVertexFromFace(e,t){return e===t.outside&&(t.outside=e.next!==null&&e.next.face===t?e.next:null),this.assigned.remove(e),this}_removeAllVerticesFromFace(e){if(e.outside!==null){let t=e.outside,n=e.outside;for(;n.next!==null&&n.next.face===e;)n=n.next;return this.assigned.removeSubList(t,n),t.prev=n.next=null,e.outside=null,t}}_deleteFaceVertices(e,t){let n=this._removeAllVerticesFromFace(e);if(n!==void 0){if(t===void 0)this.unassigned.appendChain(n);else{let e=n;do{let n=e.next;t.distanceToPoint(e.point)>this.tolerance?this._addVertexToFace(e,t):this.unassigned.append(e),e=n}while(e!==null)}}return this}_resolveUnassignedPoints(e){if(this.unassigned.isEmpty()===!1){let t=this.unassigned.first();do{let n=t.next,r=this.tolerance,i=null;for(let n=0;n<e.length;n++){let a=e[n];if(a.mark===yw){let e=a.distanceToPoint(t.point);if(e>r&&(r=e,i=a),r>1e3*this.tolerance)break}}i!==null&&this._addVertexToFace(t,i),t=n}while(t!==null)}return this}_computeExtremes(){let e=new X,t=new X,n=[],r=[];for(let e=0;e<3;e++)n[e]=r[e]=this.vertices[0];e.copy(this.vertices[0].point),t.copy(this.vertices[0].point);for(let i=0,a=this.vertices.length;i<a;i++){let a=this.vertices[i],o=a.point;for(let t=0;t<3;t++)o.getComponent(t)<e.getComponent(t)&&(e.setComponent(t,o.getComponent(t)),n[t]=a);for(let e=0;e<3;e++)o.getComponent(e)>t.getComponent(e)&&(t.setComponent(e,o.getComponent(e)),r[e]=a)}return this.tolerance=3*2**-52*(Math.max(Math.abs(e.x),Math.abs(t.x))+Math.max(Math.abs(e.y),Math.abs(t.y))+Math.max(Math.abs(e.z),Math.abs(t.z))),{min:n,max:r}}_computeInitialHull(){let e=this.vertices,t=this._computeExtremes(),n=t.min,r=t.max,i=0,a=0;for(let e=0;e<3;e++){let t=r[e].point.getComponent(e)-n[e].point.getComponent(e);t>i&&(i=t,a=e)}let o=n[a],s=r[a],c,l;i=0,Sw.set(o.point,s.point);for(let t=0,n=this.vertices.length;t<n;t++){let n=e[t];if(n!==o&&n!==s){Sw.closestPointToPoint(n.point,!0,ww);let e=ww.distanceToSquared(n.point);e>i&&(i=e,c=n)}}i=-1,Cw.setFromCoplanarPoints(o.point,s.point,c.point);for(let t=0,n=this.vertices.length;t<n;t++){let n=e[t];if(n!==o&&n!==s&&n!==c){let e=Math.abs(Cw.distanceToPoint(n.point));e>i&&(i=e,l=n)}}let u=[];if(Cw.distanceToPoint(l.point)<0){u.push(Dw.create(o,s,c),Dw.create(l,s,o),Dw.create(l,c,s),Dw.create(l,o,c));for(let e=0;e<3;e++){let t=(e+1)%3;u[e+1].getEdge(2).setTwin(u[0].getEdge(t)),u[e+1].getEdge(1).setTwin(u[t+1].getEdge(0))}}else{u.push(Dw.create(o,c,s),Dw.create(l,o,s),Dw.create(l,s,c),Dw.create(l,c,o));for(let e=0;e<3;e++){let t=(e+1)%3;u[e+1].getEdge(2).setTwin(u[0].getEdge((3-e)%3)),u[e+1].getEdge(0).setTwin(u[t+1].getEdge(1))}}for(let e=0;e<4;e++)this.faces.push(u[e]);for(let t=0,n=e.length;t<n;t++){let n=e[t];if(n!==o&&n!==s&&n!==c&&n!==l){i=this.tolerance;let e=null;for(let t=0;t<4;t++){let r=this.faces[t].distanceToPoint(n.point);r>i&&(i=r,e=this.faces[t])}e!==null&&this._addVertexToFace(n,e)}}return this}_reindexFaces(){let e=[];for(let t=0;t<this.faces.length;t++){let n=this.faces[t];n.mark===yw&&e.push(n)}return this.faces=e,this}_nextVertexToAdd(){if(this.assigned.isEmpty()===!1){let e,t=0,n=this.assigned.first().face,r=n.outside;do{let i=n.distanceToPoint(r.point);i>t&&(t=i,e=r),r=r.next}while(r!==null&&r.face===n);return e}}_computeHorizon(e,t,n,r){this._deleteFaceVertices(n),n.mark=bw;let i;i=t===null?t=n.getEdge(0):t.next;do{let t=i.twin,n=t.face;n.mark===yw&&(n.distanceToPoint(e)>this.tolerance?this._computeHorizon(e,t,n,r):r.push(i)),i=i.next}while(i!==t);return this}_addAdjoiningFace(e,t){let n=Dw.create(e,t.tail(),t.head());return this.faces.push(n),n.getEdge(-1).setTwin(t.twin),n.getEdge(0)}_addNewFaces(e,t){this.newFaces=[];let n=null,r=null;for(let i=0;i<t.length;i++){let a=t[i],o=this._addAdjoiningFace(e,a);n===null?n=o:o.next.setTwin(r),this.newFaces.push(o.face),r=o}return n.next.setTwin(r),this}_addVertexToHull(e){let t=[];return this.unassigned.clear(),this._removeVertexFromFace(e,e.face),this._computeHorizon(e.point,null,e.face,t),this._addNewFaces(e,t),this._resolveUnassignedPoints(this.newFaces),this}_cleanup(){return this.assigned.clear(),this.unassigned.clear(),this.newFaces=[],this}_compute(){let e;for(this._computeInitialHull();(e=this._nextVertexToAdd())!==void 0;)this._addVertexToHull(e);return this._reindexFaces(),this._cleanup(),this}},Dw=class e{constructor(){this.normal=new X,this.midpoint=new X,this.area=0,this.constant=0,this.outside=null,this.mark=yw,this.edge=null}static create(t,n,r){let i=new e,a=new Ow(t,i),o=new Ow(n,i),s=new Ow(r,i);return a.next=s.prev=o,o.next=a.prev=s,s.next=o.prev=a,i.edge=a,i.compute()}getEdge(e){let t=this.edge;for(;e>0;)t=t.next,e--;for(;e<0;)t=t.prev,e++;return t}compute(){let e=this.edge.tail(),t=this.edge.head(),n=this.edge.next.head();return Tw.set(e.point,t.point,n.point),Tw.getNormal(this.normal),Tw.getMidpoint(this.midpoint),this.area=Tw.getArea(),this.constant=this.normal.dot(this.midpoint),this}distanceToPoint(e){return this.normal.dot(e)-this.constant}},Ow=class{constructor(e,t){this.vertex=e,this.prev=null,this.next=null,this.twin=null,this.face=t}head(){return this.vertex}tail(){return this.prev?this.prev.vertex:null}length(){let e=this.head(),t=this.tail();return t===null?-1:t.point.distanceTo(e.point)}lengthSquared(){let e=this.head(),t=this.tail();return t===null?-1:t.point.distanceToSquared(e.point)}setTwin(e){return this.twin=e,e.twin=this,this}},kw=class{constructor(e){this.point=e,this.prev=null,this.next=null,this.face=null}},Aw=class{constructor(){this.head=null,this.tail=null}first(){return this.head}last(){return this.tail}clear(){return this.head=this.tail=null,this}insertBefore(e,t){return t.prev=e.prev,t.next=e,t.prev===null?this.head=t:t.prev.next=t,e.prev=t,this}insertAfter(e,t){return t.prev=e,t.next=e.next,t.next===null?this.tail=t:t.next.prev=t,e.next=t,this}append(e){return this.head===null?this.head=e:this.tail.next=e,e.prev=this.tail,e.next=null,this.tail=e,this}appendChain(e){for(this.head===null?this.head=e:this.tail.next=e,e.prev=this.tail;e.next!==null;)e=e.next;return this.tail=e,this}remove(e){return e.prev===null?this.head=e.next:e.prev.next=e.next,e.next===null?this.tail=e.prev:e.next.prev=e.prev,this}removeSubList(e,t){return e.prev===null?this.head=t.next:e.prev.next=t.next,t.next===null?this.tail=e.prev:t.next.prev=e.prev,this}isEmpty(){return this.head===null}},jw=class extends lp{constructor(e=[]){super();let t=[],n=[],r=new Ew().setFromPoints(e).faces;for(let e=0;e<r.length;e++){let i=r[e],a=i.edge;do{let e=a.head().point;t.push(e.x,e.y,e.z),n.push(i.normal.x,i.normal.y,i.normal.z),a=a.next}while(a!==i.edge)}this.setAttribute(`position`,new Q(t,3)),this.setAttribute(`normal`,new Q(n,3))}},Mw={units:14,part:.5},Nw=[`universal`,`constant_velocity`],Pw=.999,Fw=.05;function Iw(e,t){let n=Lw(e,t);return(n?e.jointsOf(t).map(({joint:e})=>e.body_i===t?e.body_j:e.body_i):[]).some(t=>Lw(e,t))?n:void 0}function Lw(e,t){if(t===0||e.plane||e.vehicle||e.large||e.report.wheels.length>0)return;let n=e.jointsOf(t);if(n.length!==2||e.shapePoints(t).length!==2||n.some(({joint:e,axis:t})=>e.kind!==`revolute`||e.hinge||!t))return;let[r,i]=n.map(({axis:e})=>e.clone().normalize()),a=n[1].at.clone().sub(n[0].at).normalize();return Math.abs(r.dot(i))>Pw&&Math.abs(r.dot(a))<Fw?r:void 0}var Rw={half:3.4,inner:1.5};function zw(e,t){let n=e.jointsOf(t).find(({joint:e})=>e.kind===`revolute`&&(e.body_i===0||e.body_j===0)&&!e.hinge);if(!n?.axis||e.placesOf(t).length!==1)return;let r=Vw(e,n.joint)[0];return e.same(r,new X(...n.joint.at_i))?void 0:n.axis.clone().normalize()}function Bw(e,{body_i:t,body_j:n,at_i:r,at_j:i,axis:a,axis_j:o}){let s=t>0||n===0,c=s?a:o;return{body:s?t:n,at:new X(...s?r:i),axis:c?new X(...c).normalize():e.into(s?t:n,new X(0,0,1))}}function Vw(e,t){if(t.hinge&&!e.plane)return t.hinge.map(e=>new X(...e));let n=new X(...t.at_i);if(e.plane||!t.axis||t.body_i!==0&&t.body_j!==0)return[n];let{body:r,at:i,axis:a}=Bw(e,t);if(!e.jointsOf(r).some(t=>Nw.includes(t.joint.kind)&&e.same(t.at,i)))return[n];let o=e.report.bodies[r].skeleton.map(e=>new X(...e).sub(i).dot(a)).reduce((e,t)=>Math.abs(t)>Math.abs(e)?t:e,0),s=Math.sign(o)*Math.min(Mw.units*e.unit,Mw.part*Math.abs(o));return[n.addScaledVector(e.into(t.body_i,e.alongAt(r,a,0)),s)]}function Hw(e,t,n){let r=e.shapePoints(t).filter(t=>!e.same(t,n));return r.length>0?r.reduce((e,t)=>e.add(t),new X).divideScalar(r.length):n.clone()}function Uw(e,t,n,r){let i=Hw(e,t,n).sub(n),a=zw(e,t);return a?a.multiplyScalar(Math.sign(a.dot(i))||1):i.length()>1e-6*e.size?i.normalize():r.clone()}var Ww=.02,Gw=.03,Kw=2.4,qw={thick:1.15,thin:.98,slender:.12},Jw={width:1.45,twisted:2.3,thickness:.62,waist:.28,eye:1.75,height:1.9,end:1.3,sections:16},Yw=.98,Xw={thickness:.9,eye:1.5,clear:2},Zw={corner:.85,hinge:1.15,along:.75,web:.38,platform:.6},Qw={edge:.55,corner:.95,opacity:.45};function $w(e,t,n){let r=e.shapePoints(n);if(r.length===0)return[];if(r.length===1)return nT(e,t,n,r[0]);let[i,a]=EC(r,(e,t)=>e.distanceTo(t)),o=zw(e,n);if(o)return eT(e,t,n,r,o);let s=Iw(e,n);if(s)return tT(e,t,n,i,a,s);let c=a.clone().sub(i),l=c.length();c.divideScalar(l);let u=e=>e.clone().sub(i).cross(c),d=r.reduce((e,t)=>u(t).length()>u(e).length()?t:e);if(u(d).length()<Ww*l)return iT(e,t,n,i,a);let f=u(d).normalize();return r.every(e=>Math.abs(e.clone().sub(i).dot(f))<Gw*l)?oT(e,t,n,r,f):cT(t,n,r)}function eT(e,t,n,r,i){let a=t.unit,o=t.body(n),[s]=e.placesOf(n),c=e=>s.clone().addScaledVector(i,e.clone().sub(s).dot(i));return r.filter(t=>!e.same(t,s)).flatMap(e=>{let n=c(e),r=n.distanceTo(e)>a?[t.cylinder(n,e,qw.thin*a,qw.thin*a,o),t.ball(e,qw.thick*a,o)]:[];return[t.cylinder(s,n,qw.thick*a,qw.thick*a,o),t.ball(n,1.5*qw.thick*a,o),...r]})}function tT(e,t,n,r,i,a){let o=t.unit,s=t.body(n),c=i.clone().sub(r).normalize(),l=r.clone().lerp(i,.5);return[t.brick(l,c,a,[Math.max(o,r.distanceTo(i)-2*Xw.clear*o),2*Rw.half*o,Xw.thickness*o],s),...e.jointsOf(n).flatMap(({joint:e,at:r})=>{let i=e.body_i===0||e.body_j===0||e.body_i===n,c=(Rw.half+Rw.inner)/2,u=i?[[0,2*Rw.inner]]:[[-c,Rw.half-Rw.inner],[c,Rw.half-Rw.inner]],d=l.clone().sub(r).normalize();return u.flatMap(([e,n])=>{let i=r.clone().addScaledVector(a,e*o),c=i.clone().addScaledVector(d,Xw.clear/2*o);return[t.disc(i,a,Xw.eye*o,.94*n*o,s),t.brick(c,d,a,[Xw.clear*o,.94*n*o,Xw.thickness*o],s,{})]})})]}function nT(e,t,n,r){let{report:i}=e,a=i.joints.flatMap((t,r)=>e.slideOf(r)?.block===n?[r]:[]),o=i.couplers.some(({terms:e})=>e.some(({joint:e})=>[i.joints[e].body_i,i.joints[e].body_j].includes(n)));if(a.length>0||o)return[];let s=rT(e,n,r)??e.into(n,e.up);return[t.disc(r,s,Kw*t.unit,.8*Kw*t.unit,t.body(n))]}function rT(e,t,n){return e.jointsOf(t).filter(({joint:e})=>e.kind===`revolute`||e.kind===`cylindrical`).find(t=>t.axis&&e.same(t.at,n))?.axis}function iT(e,t,n,r,i){let a=t.unit,o=t.body(n),s=r.distanceTo(i),c=i.clone().sub(r).divideScalar(s),l=t=>{let r=rT(e,n,t);return r&&Math.abs(r.dot(c))<.5*r.length()?bC(r,c):void 0},[u,d]=[l(r),l(i)];if(!u&&!d){let e=Math.min(qw.thick*a,qw.slender*s),n=qw.thin/qw.thick*e;return[t.cylinder(r,i,e,n,o),t.ball(r,e,o),t.ball(i,n,o)]}let f=u??d,p=(d??u).clone();f.dot(p)<0&&p.negate();let[m,h]=[r,i].map(t=>u&&d?aT(e,n,t,a):t),g=u&&d&&f.dot(p)<Yw?Jw.twisted:Jw.width,_=e=>{let t=f.clone().lerp(p,e).normalize(),n=t.clone().cross(c),r=g*a*(1-Jw.waist*Math.sin(Math.PI*e));return[[-1,-1],[1,-1],[1,1],[-1,1]].map(([i,o])=>m.clone().lerp(h,e).addScaledVector(n,i*r).addScaledVector(t,o*Jw.thickness*a))},v=Array.from({length:Jw.sections+1},(e,t)=>_(t/Jw.sections)),y=v.slice(1).flatMap((e,t)=>[0,1,2,3].flatMap(n=>{let[r,i]=[v[t],(n+1)%4];return[r[n],e[i],r[i],r[n],e[n],e[i]]})),b=(e,n)=>n?t.disc(e,n,Jw.eye*a,Jw.height*a,o):t.ball(e,Jw.end*a,o),x=[0,1,2,3].map(e=>t.line(v.map(t=>t[e]),t.palette.outline,.9,{opacity:.45}));return[t.triangles(y,o,{open:!0,facets:!0}),...x,b(m,rT(e,n,r)),b(h,rT(e,n,i))]}function aT(e,t,n,r){let i=e.jointsOf(t).find(({joint:t,at:r})=>t.kind===`revolute`&&e.same(r,n));if(!i?.axis||i.joint.body_i===0||i.joint.body_j===0||i.joint.hinge)return n;let a=i.joint.body_i===t?-1:1;return n.clone().addScaledVector(i.axis.clone().normalize(),a*Jw.height*r/2)}function oT(e,t,n,r,i){let a=t.unit,o=t.body(n),s=new vC(r[0],i),c=r.map(e=>s.to(e)),l=xC(c),u=l.map(e=>r[c.indexOf(e)]),d=sT(e,n,r),f=u.flatMap((e,n)=>{let r=u[(n+1)%u.length],i=d.includes(e)&&d.includes(r),s=e=>(i?Zw.along:d.includes(e)?Zw.hinge:Zw.corner)*a;return[t.cylinder(e,r,s(e),s(r),o),t.ball(e,Zw.hinge*a,o)]}),p=r.filter(e=>!u.includes(e)),m=u.reduce((e,t)=>e.add(t),new X).divideScalar(u.length),h=p.flatMap(e=>{let n=[...u].sort((t,n)=>t.distanceTo(e)-n.distanceTo(e)).slice(0,2);return[...(e.distanceTo(m)<2*a?[]:n).map(n=>t.cylinder(e,n,.75*a,.75*a,o)),t.ball(e,Zw.hinge*a,o)]}),g=new Xh(new oh(l.map(([e,t])=>new Y(e,t)))).applyMatrix4(s.matrix());return[...f,...h,t.mesh(g,o,{opacity:l.length>3?Zw.platform:Zw.web})]}function sT(e,t,n){let r=.002*e.size;return e.jointsOf(t).filter(({joint:e,axis:t})=>e.kind===`revolute`&&t).map(({at:e,axis:t})=>n.filter(n=>n.clone().sub(e).cross(t).length()<r)).find(e=>e.length>1)??[]}function cT(e,t,n){let r=e.unit,i=e.body(t),a=new jw(n),o=new km(a,1),{position:s}=o.attributes,c=e=>new X().fromBufferAttribute(s,e),l=Array.from({length:s.count/2},(t,n)=>e.cylinder(c(2*n),c(2*n+1),Qw.edge*r,Qw.edge*r,i));return o.dispose(),[e.mesh(a,i,{opacity:Qw.opacity,facets:!0}),...l,...n.map(t=>e.ball(t,Qw.corner*r,i))]}var lT=1.5,uT={radius:2.8,height:2.2},dT=[1.7,1],fT=.22,pT=.12,mT=3;function hT(e,t,n,r){let i=t.unit,a=t.body(n),o=new X(...r.centre.at),s=new X(...r.axis).normalize(),c=e.shapePoints(n).filter(e=>e.distanceTo(o)>i),l=c.map(e=>e.clone().sub(o).dot(s)),u=l.reduce((e,t)=>e+t,0)/(l.length||1),d=Math.sign(u)||-1,f=o.clone().addScaledVector(s,d*Math.max(Math.abs(u),pT*r.radius)),p=[t.cylinder(f,o,lT*i,lT*i,a),t.disc(f,s,uT.radius*i,uT.height*i,a),t.disc(o.clone().addScaledVector(s,d*.5*i),s,fT*r.radius,i,a)],m=(e,n)=>{e.distanceTo(n)<i||p.push(t.cylinder(e,n,dT[0]*i,dT[1]*i,a),t.ball(n,1.1*dT[1]*i,a))};return c.length>mT?p.push(...gT(t,c,f,s,a,m)):c.forEach(e=>m(f,e)),p}function gT(e,t,n,r,i,a){let o=e.unit,s=new vC(n,r),c=t.map(e=>s.to(e)),l=xC(c);if(l.length<3||TC(l)<20*o*o)return t.forEach(e=>a(n,e)),[];let u=l.map(e=>t[c.indexOf(e)]),d=u.flatMap((t,r)=>{let a=u[(r+1)%u.length];return[e.cylinder(t,a,dT[1]*o,dT[1]*o,i),e.triangles([n,t,a],i,{open:!0,facets:!0}),e.ball(t,1.2*dT[1]*o,i)]});for(let e of t)u.includes(e)||a(n,e);return d}function _T(e,t){let{report:n}=e;return n.bodies.flatMap(({mesh:n},r)=>{if(r===0||n)return[];let i=vT(e,t,r);return i.length===0?[]:[{body:r,object:new cf().add(...i),part:ZC(e,r)}]})}function vT(e,t,n){let{report:r}=e,i=r.wheels.filter(({centre:e})=>e.body===n);return i.length>1?aw(e,t,n,i):i.length===1?hT(e,t,n,i[0]):r.joints.some(({curve:e,body_i:t})=>e&&t===n)?[]:e.plane?e.large?gw(e,t,n):hw(e,t,n):$w(e,t,n)}var yT=3.4,bT=7,xT=2.2,ST=.999,CT=.001,wT=class{mechanism;face;#e=new Map;#t=new Map;#n=[];constructor(e){this.mechanism=e,this.face=yT*e.unit;let t=new Map;e.report.couplers.forEach((n,r)=>{for(let{joint:e,turns:t}of n.terms)t&&this.shaftOf(e);let i=this.#i(n);if(!i)return;let[a,o]=i.map(({shaft:e})=>e),s=Math.max(...[a,o].map(({joint:e})=>(t.get(e)??-1)+1));for(let{joint:e}of[a,o])t.set(e,s);let c=e.plane?0:bT*e.unit+s*xT*this.face;i[0].centre=a.at.clone().addScaledVector(a.axis,c);let l=i[0].centre.clone().sub(o.at).dot(o.axis);i[1].centre=o.at.clone().addScaledVector(o.axis,l),TT(a,c),TT(o,l),this.#t.set(r,i)})}get shafts(){return[...this.#e.values()]}shaftOf(e){let t=this.#e.get(e),n=this.mechanism.report.joints[e];if(t||n?.kind!==`revolute`||!n.axis)return t;let r={joint:e,body:n.body_j>0?n.body_j:n.body_i,at:this.mechanism.worldAt(n.body_i,new X(...n.at_i),0),axis:this.mechanism.alongAt(n.body_i,new X(...n.axis),0).normalize(),low:0,high:0};return this.#e.set(e,r),r}pair(e){return this.#t.get(e)}toothing(e,t,n,r){let i=this.#n.find(r=>r.body===e.body&&r.teeth===t&&Math.abs(r.radius-n)<CT*n&&r.centre.distanceTo(e.centre)<CT*n);if(!i)return;let a=r.clone().normalize(),o=i.towards.clone().normalize();return i.phase+Math.atan2(a.clone().cross(o).dot(e.shaft.axis),a.dot(o))}tooth({body:e,centre:t},n,r,i,a){this.#n.push({body:e,centre:t,teeth:n,radius:r,towards:i,phase:a})}#r({joint:e}){let{body_i:t,body_j:n}=this.mechanism.report.joints[e];return[t,n]}#i({kind:e,terms:t}){if(e!==`gear`&&e!==`belt`||t.length!==2)return;let n=t.flatMap(({joint:e,coefficient:t,turns:n})=>{let r=n?this.shaftOf(e):void 0;return r?[{shaft:r,body:r.body,centre:r.at,coefficient:t}]:[]});if(n.length!==2)return;let[r,i]=n,[a,o]=n.map(({shaft:e})=>this.#r(e)),s=a.filter(e=>o.includes(e));if(s.length===1){let e=e=>e.find(e=>e!==s[0]);r.body=e(a),i.body=e(o)}return Math.abs(r.shaft.axis.dot(i.shaft.axis))>ST?[r,i]:void 0}};function TT(e,t){e.low=Math.min(e.low,t),e.high=Math.max(e.high,t)}var ET=72;function DT(e,t,n,r=!1){let i=r?-t:t,a=(e-i)/n;if(!(Math.abs(a)<1))return;let o=Math.acos(a),s=[],c=[],l=(e,t,n,r,i)=>{let a=Math.max(2,Math.ceil(ET*Math.abs(r-n)/(2*Math.PI)));for(let o=0;o<=a;o++){let l=n+(r-n)*o/a,u=[Math.cos(l),Math.sin(l)];s.push([e+t*u[0],t*u[1]]),c.push([i*u[0],i*u[1]])}};l(0,e,o,2*Math.PI-o,1),r?l(n,t,Math.PI-o,o-Math.PI,-1):l(n,t,-o,o,1);let u=Math.sqrt(n**2-(e-i)**2),d=r?(e+t)*(2*Math.PI-2*o):e*(2*Math.PI-2*o)+t*2*o;return{points:s,normals:c,length:2*u+d}}var OT={thickness:.9,width:.8},kT={radius:.72,width:1.06},AT={at:.5,radius:.09},jT=({mechanism:e,kit:t,train:n,coupler:r,index:i})=>{let a=n.pair(i);if(!a||r.sizes.length<2)return[];let[o,s]=a,c=r.sizes.map(Math.abs),l=s.centre.clone().sub(o.centre),u=o.coefficient*s.coefficient*o.shaft.axis.dot(s.shaft.axis)>0,d=e.plane?e.thickness:n.face,f=a.map(({shaft:n,body:r,centre:i},a)=>{let o=e.placeInto(r,i).add(e.lift(r)),s=e.into(r,n.axis),u=t.body(r),f=new vC(o,s,e.into(r,l)).from([AT.at*c[a],0]);return{body:r,object:new cf().add(t.disc(o,s,c[a],d,u),t.disc(o,s,kT.radius*c[a],kT.width*d,u,{edges:60}),t.disc(f,s,AT.radius*c[a],(kT.width+.04)*d,t.palette.view))}}),p=DT(c[0],c[1],l.length(),u);if(!p)return f;let{body_i:m,body_j:h}=e.report.joints[o.shaft.joint],g=h>0?m:h,_=new vC(e.placeInto(g,o.centre).add(e.lift(o.shaft.body)),e.into(g,o.shaft.axis),e.into(g,l));return[...f,{body:g,object:MT(t,_,p,OT.width*d)}]};function MT(e,t,{points:n,normals:r},i){let a=OT.thickness*e.unit,o=n.map(([e,n],o)=>{let[s,c]=r[o];return[[0,-1],[1,-1],[1,1],[0,1]].map(([r,o])=>t.from([e+r*a*s,n+r*a*c],o*i/2))}),s=o.flatMap((e,t)=>{let n=o[(t+1)%o.length];return e.flatMap((t,r)=>{let i=(r+1)%e.length;return[t,n[r],n[i],t,n[i],e[i]].map(e=>e.clone())})});return e.triangles(s,e.palette.rubber,{facets:!0,open:!0})}var NT=12,PT=48,FT=144,IT=.001,LT={ofPitch:.62,ofRadius:.16},RT=.26,zT=.1;function BT([e,t]){let[n,r]=e<t?[e,t]:[t,e];if(Number.isInteger(e)&&Number.isInteger(t)&&n>=NT&&n<=PT&&r<=FT)return[e,t];let i=e=>Math.abs(e*r/n-Math.round(e*r/n))/(e*r/n),a=Array.from({length:37},(e,t)=>NT+t),o=a.find(e=>i(e)<IT)??a.reduce((e,t)=>i(t)<i(e)?t:e),s=Math.round(o*r/n);return e<t?[o,s]:[s,o]}function VT(e,t){return Math.min(LT.ofPitch*2*Math.PI*t/e,LT.ofRadius*t)}function HT(e,t,n,r=0,i=!1){let a=n/2,[o,s]=i?[t+a,t-a]:[t-a,t+a],c=[[-.26,o],[-.1,s],[zT,s],[RT,o]];return Array.from({length:e},(e,t)=>t).flatMap(t=>c.map(([n,i])=>{let a=r+(t+n)*2*Math.PI/e;return[i*Math.cos(a),i*Math.sin(a)]}))}function UT(e,t,n,r,i){let a=Math.ceil(t/e-.5),o=Math.max(a,Math.floor(n/e-.5)),s=Array.from({length:o-a+1},(t,n)=>(a+n+.5)*e),c=t=>[[t+RT*e,-r/2],[t+zT*e,r/2],[t-zT*e,r/2],[t-RT*e,-r/2]],[l,u]=[(a+0)*e,(o+1)*e];return[[l,-i],[u,-i],[u,-r/2],...s.reverse().flatMap(c),[l,-r/2]]}var WT=.85,GT=.92,KT=.1;function qT(e,t){let[n,r]=[e.axis.clone().normalize(),t.axis.clone().normalize()],i=n.dot(r),a=1-i*i;if(a<KT**2)return;let o=t.at.clone().sub(e.at),s=e.at.clone().addScaledVector(n,(o.dot(n)-i*o.dot(r))/a),c=n.clone().multiplyScalar(t.coefficient).addScaledVector(r,e.coefficient).normalize();if(!(c.lengthSq()>0))return;let[l,u]=[e.at.clone().sub(s),t.at.clone().sub(s)],d=Math.abs(c.dot(n))<Math.abs(c.dot(r))?[c.dot(n)*l.dot(n),c.dot(r)*u.dot(r)]:[c.dot(r)*u.dot(r),c.dot(n)*l.dot(n)];(d[0]<0||d[0]===0&&d[1]<0)&&c.negate();let f=[[n,l],[r,u]],p=Math.min(...f.map(([,e])=>e.length()).filter(e=>e>0)),m=f.map(([e,t])=>{let n=c.dot(e),r=GT*p/Math.sqrt(1-n*n);return n*t.dot(e)>0?Math.min(r,WT*t.length()/Math.abs(n)):r}),h=Math.min(...m);if(!Number.isFinite(h)||h<=0)return;let g=e=>{let t=c.dot(e);return{axis:e.clone().multiplyScalar(Math.sign(t)||1),radius:h*Math.sqrt(1-t*t),distance:h*Math.abs(t)}};return{tip:s,line:c,length:h,gears:[g(n),g(r)]}}function JT(e,{terms:t}){let n=t.flatMap(({joint:t,turns:n,coefficient:r})=>{let i=n?e.shaftOf(t):void 0;return i?[{at:i.at,axis:i.axis,coefficient:r}]:[]});return n.length===2?qT(n[0],n[1]):void 0}function YT(e,{axis:t,radius:n,distance:r},i,a,o,s,c){let l=HT(a,n,o,s),u=new vC(e.clone().addScaledVector(t,r),t,i),d=Math.max(.3,1-c/Math.hypot(n,r)),f=new vC(e.clone().addScaledVector(t,d*r),t,i),p=l.map(e=>u.from(e)),m=l.map(([e,t])=>f.from([d*e,d*t]));return p.flatMap((e,t)=>{let n=(t+1)%p.length;return[e,p[n],m[n],e,m[n],m[t],u.origin,p[n],e,f.origin,m[t],m[n]].map(e=>e.clone())})}var XT={ofLength:.35,faces:1.3},ZT=({mechanism:e,kit:t,train:n,coupler:r})=>{let i=r.terms.flatMap(({joint:e,turns:t})=>t?n.shaftOf(e)??[]:[]);if(i.length!==2||r.sizes.length<2)return[];let a=JT(n,r);if(!a)return[];let o=BT([Math.abs(r.sizes[0]),Math.abs(r.sizes[1])]),s=Math.min(...a.gears.map(({radius:e},t)=>VT(o[t],e))),c=Math.min(XT.ofLength*a.length,XT.faces*n.face);return a.gears.map((n,r)=>{let{body:l,axis:u,at:d}=i[r];TT(i[r],a.tip.clone().addScaledVector(n.axis,n.distance).sub(d).dot(u));let f=t=>e.into(l,t),p=e.placeInto(l,a.tip),m=r===0?0:Math.PI/o[1],h=YT(p,{...n,axis:f(n.axis)},f(a.line),o[r],s,m,c);return{body:l,object:t.triangles(h,t.body(l),{facets:!0,edges:50,open:!0})}})},QT={count:5,at:.56,radius:.17,above:14},$T=96,eE=({mechanism:e,kit:t,train:n,coupler:r,index:i})=>{let a=n.pair(i);if(!a||r.sizes.length<2)return[];let[o,s]=a,c=s.centre.clone().sub(o.centre),l=c.length(),u=Math.sign(o.coefficient*s.coefficient*o.shaft.axis.dot(s.shaft.axis)),d=[Math.abs(r.sizes[0]),Math.abs(r.sizes[1])],[f,p]=BT(d),m=u<0,h=m?l/Math.abs(d[0]-d[1]):l/(d[0]+d[1]),g=d.map(e=>e*h);if(!(l>1e-6*e.size)||!g.every(Number.isFinite))return[];let _=Math.min(VT(f,g[0]),VT(p,g[1])),v=c.clone().multiplyScalar(m&&d[0]<d[1]?-1:1),y=c.clone().multiplyScalar(m&&d[0]<d[1]?-1:m?1:-1),[b,x]=[n.toothing(o,f,g[0],v),n.toothing(s,p,g[1],y)],S=(m?1:-1)*Math.sign(o.shaft.axis.dot(s.shaft.axis)),C=b??(x===void 0?0:S*p*(x-Math.PI/p)/f),w=x??S*f*C/p+Math.PI/p;return b===void 0&&n.tooth(o,f,g[0],v,C),x===void 0&&n.tooth(s,p,g[1],y,w),[{wheel:o,teeth:f,radius:g[0],towards:v,phase:C,ring:m&&d[0]>d[1],known:b!==void 0},{wheel:s,teeth:p,radius:g[1],towards:y,phase:w,ring:m&&d[1]>d[0],known:x!==void 0}].filter(({known:e})=>!e).map(({wheel:r,teeth:i,radius:a,towards:o,phase:s,ring:c})=>{let{body:l}=r,u=t=>e.into(l,t),d=new vC(e.placeInto(l,r.centre).add(e.lift(l)),u(r.shaft.axis),u(o)),f=HT(i,a,_,s,c),p=e.plane?e.thickness:n.face,m=c?[t.slab(CC([[0,0,a*1.18]]),d,p,t.body(l),[f],{edges:50})]:[t.slab(f,d,p,t.body(l),tE(a,t.unit),{edges:50})];return{body:l,object:new cf().add(...m,...nE(t,d,a,p))}})};function tE(e,t){return e<=QT.above*t?[]:Array.from({length:QT.count},(e,t)=>2*Math.PI*t/QT.count).map(t=>CC([[QT.at*e*Math.cos(t),QT.at*e*Math.sin(t),QT.radius*e]]))}function nE(e,t,n,r){return[-1,1].map(i=>{let a=Array.from({length:97},(a,o)=>{let s=2*Math.PI*o/$T;return t.from([n*Math.cos(s),n*Math.sin(s)],i*(r/2+.06*e.unit))});return e.line(a,e.palette.outline,1,{dashed:!0,opacity:.8})})}var rE={pinion:16,rack:14,beyond:3},iE=2.6,aE={radius:1.3,beyond:7},oE=[5,2],sE=({mechanism:e,kit:t,train:n,coupler:r})=>{let[i,a]=r.terms,o=e.report.joints[i?.joint],s=a?.turns?n.shaftOf(a.joint):void 0;if(!o?.axis||!s)return[];let c=-a.coefficient/i.coefficient,l=Math.abs(r.sizes[0]??c),u=o.body_j>0?o.body_j:o.body_i,d=e.alongAt(o.body_i,new X(...o.axis),0).normalize(),f=d.clone().cross(s.axis).multiplyScalar(Math.sign(c)||1);if(!(l>0)||f.length()<.5)return[];f.normalize();let p=e.worldAt(o.body_i,new X(...o.at_i),0),m=p.clone().sub(s.at).dot(s.axis),h=s.at.clone().addScaledVector(s.axis,m);TT(s,m);let g=2*Math.PI*l/rE.pinion,_=VT(rE.pinion,l),v=e.plane?e.thickness:n.face,y={at:e.placeInto(s.body,h).add(e.lift(s.body)),axis:e.into(s.body,s.axis)},b=new vC(y.at,y.axis,e.into(s.body,f)),x=t.slab(HT(rE.pinion,l,_),b,v,t.body(s.body),[],{edges:50}),S=new X(...u===o.body_j?o.at_j:o.at_i),C=e.worldAt(u,S,0),w=e.moments.map(t=>e.worldAt(u,S,t).sub(C).dot(d)).filter(Number.isFinite),T=Math.max(rE.beyond*g,(rE.rack*g-(Math.max(0,...w)-Math.min(0,...w)))/2),[E,D]=[-Math.max(0,...w)-T,-Math.min(0,...w)+T],O=h.clone().addScaledVector(f,l),k=t=>e.into(u,t),A=t=>e.placeInto(u,t).add(e.lift(u)),j=iE*t.unit+_/2,M=f.clone().negate().cross(s.axis),N=Math.sign(M.dot(d))||1,ee=new vC(A(O),k(s.axis),k(M)),te=N>0?UT(g,E,D,_,j):UT(g,-D,-E,_,j),ne=t.slab(te,ee,v,t.body(u),[],{edges:50}),re=C.clone().addScaledVector(d,O.clone().sub(C).dot(d)),P=O.clone().addScaledVector(f,j-.5*t.unit),F=re.clone().sub(P),ie=F.dot(f),I=[ne],L=p.clone().sub(C).dot(d),[R,z]=[Math.min(E+O.clone().sub(C).dot(d),L-Math.max(0,...w))-aE.beyond*t.unit,Math.max(D+O.clone().sub(C).dot(d),L-Math.min(0,...w))+aE.beyond*t.unit].map(e=>A(C.clone().addScaledVector(d,e)));if(Math.abs(ie)>j/2){I.push(t.cylinder(R,z,aE.radius*t.unit,aE.radius*t.unit,t.body(u)));for(let e of[.25,.75]){let n=E+e*(D-E),r=P.clone().lerp(re,.5).addScaledVector(d,n);I.push(t.brick(A(r),k(F),k(d),[F.length(),oE[0]*t.unit,oE[1]*t.unit],t.body(u)))}}return[{body:s.body,object:new cf().add(x,...nE(t,b,l,v))},{body:u,object:new cf().add(...I)}]},cE={radius:1.1,beyond:3.2},lE={ring:2.1,section:.85},uE={from:2.4,to:5,radius:.9,plate:5.2},dE={from:5,radius:4.6,length:10},fE={from:1,radius:4.75,height:1.2};function pE(e,t,n){return e.plane?[]:n.shafts.flatMap(n=>mE(e,t,n))}function mE(e,t,n){let{report:r}=e,{joint:i,body:a,at:o,axis:s,low:c,high:l}=n,u=t.unit,{body_i:d,body_j:f}=r.joints[i],p=f>0?d:f,m=e=>o.clone().addScaledVector(s,e),h=p===0&&r.drivers.some(e=>e.joint===i&&e.turns),g=l>-c?-1:1,_=(g<0?c:l)+g*dE.from*u,v=[c-cE.beyond*u,l+cE.beyond*u];h&&(v[g<0?0:1]=_);let[y,b]=v.map(t=>e.placeInto(a,m(t))),x=[{body:a,object:t.cylinder(y,b,cE.radius*u,cE.radius*u,t.body(a)),part:ZC(e,a)}];if(x.push({body:p,object:hE(e,t,p,o,s),part:QC(e,i)}),!h)return x;let S=t.cylinder(m(_),m(_+g*dE.length*u),dE.radius*u,dE.radius*u,t.palette.ground),C=t.disc(m(_+g*fE.from*u),s,fE.radius*u,fE.height*u,t.palette.driver);return[...x,{body:0,object:new cf().add(S,C),part:ZC(e,0)}]}function hE(e,t,n,r,i){let a=t.unit,o=e.placeInto(n,r),s=e.into(n,i),c=t.mesh(new $h(lE.ring*a,lE.section*a,12,28),t.body(n));if(c.position.copy(o),c.quaternion.setFromUnitVectors(new X(0,0,1),s),n>0)return new cf().add(c);let l=e.up.clone().negate();Math.abs(l.dot(i))>.6&&l.copy(yC(i)),l.addScaledVector(i,-l.dot(i)).normalize();let u=o.clone().addScaledVector(l,uE.to*a),d=t.cylinder(o.clone().addScaledVector(l,uE.from*a),u,uE.radius*a,uE.radius*a,t.palette.ground);return new cf().add(c,d,t.footPlate(u,l,i,uE.plate*a))}var gE={gear:eE,bevel:ZT,rack:sE,belt:jT};function _E(e,t){let n=new wT(e);return[...e.report.couplers.flatMap((r,i)=>{let a=Object.hasOwn(gE,r.kind)?gE[r.kind]:void 0,o=vE(e,r,i);return(a?.({mechanism:e,kit:t,train:n,coupler:r,index:i})??[]).map(e=>({...e,part:o}))}),...pE(e,t,n)]}function vE({report:e},{name:t,kind:n,sizes:r,terms:i},a){let o=i.map(({joint:t})=>e.joints[t]?.name??``).join(` and `),s=e.units.length;return{kind:`coupler`,index:a,name:t,about:`${n}${n===`gear`||n===`bevel`?`, ${r.join(` and `)} teeth`:r.length>0?`, ${r.length>1?`radii`:`radius`} ${r.join(` and `)} ${s}`:``}, of ${o}`}}var yE={casing:1,former:2,trace:3,driver:4,dimension:5,velocity:6},bE=.42,xE=.45,SE=new X(0,1,0);function CE(e,t,n,{head:r,shaft:i},a,o,s=!1){let c=n.clone().sub(t),l=c.length(),u=Math.min(r,xE*l),[d,f]=[s?.7*u:0,l-.7*u],p=new cf().add(kE(e,new X(0,l,0),SE,u,a));return s&&p.add(kE(e,new X,SE.clone().negate(),u,a)),`pixels`in i?p.add(e.line([new X(0,d,0),new X(0,f,0)],a,i.pixels,{over:!0})):p.add(jC(AE(e,new Sm(i.radius,i.radius,f-d,12),a),new X(0,(d+f)/2,0))),DE(jC(p,t,l>0?c:SE),o)}function wE(e,t,n,r,i,a,o,s){let c=1.5*Math.PI,l=AE(e,new $h(r,a,8,48,c-i/r),o),u=new cf().add(l,EE(e,r,c,1,i,o));return u.rotation.x=-Math.PI/2,DE(jC(new cf().add(u),t,n),s)}function TE(e,t,n){let r=Math.max(2,Math.ceil(Math.abs(n-t)/.08));return Array.from({length:r+1},(i,a)=>OE(e,t+a/r*(n-t)))}function EE(e,t,n,r,i,a){let o=n-r*i/(2*t),s=new X(-Math.sin(o),Math.cos(o),0).multiplyScalar(r);return kE(e,OE(t,o).addScaledVector(s,i/2),s,i,a)}function DE(e,t){return e.traverse(e=>e.renderOrder=t),e}function OE(e,t){return new X(e*Math.cos(t),e*Math.sin(t),0)}function kE(e,t,n,r,i){return jC(AE(e,new Cm(bE*r,r,20),i),t.clone().addScaledVector(n,-r/2),n)}function AE(e,t,n){let r=e.mesh(t,n);return r.material=e.flat(n,{over:!0}),r.castShadow=!1,r}var jE={ofSize:.11,ofHeight:.75,least:9},ME=.5,NE=3.4,PE=5,FE=1e-9,IE=.001,LE=(e,t,n)=>{let r=e.report.variables[n.variable];if(!r)return[];let i=RE(e,r),a=i===void 0?`design velocity`:`design velocity, drawn for ${zE(i,r)}`,o={kind:`mark`,index:r.index,name:r.name,about:a},{chosen:s}=t.palette,c={head:NE*t.unit,shaft:{radius:ME*t.unit}},l=VE(e,r,i??0).map(({body:n,from:r,to:i})=>{let a=e.lift(n,e.topLayer+3);return{body:n,object:CE(t,r.add(a),i.add(a),c,s,yE.velocity),part:o,overlay:!0}}),u=WE(r.arrows.map(({turn:e})=>e)),d=GE(e,r.arrows.filter(({turn:e})=>h(Math.hypot(...e),u)>0)).map(({body:n,at:r,turn:i})=>({body:n,object:wE(t,UE(e,n,HE(e,n,r)).add(e.lift(n,e.topLayer+3)),new X(...i),PE*t.unit,NE*t.unit,ME*t.unit,s,yE.velocity),part:o,overlay:!0}));return[...l,...d]};function RE(e,{arrows:t}){let n=WE(t.map(({v:e})=>e));return n>FE*e.size*WE(t.map(({turn:e})=>e))?BE(e)/n:void 0}var zE=(e,{unit:t})=>`${s(e,2)} ${l(t)}`.trim();function BE({base:e,box:t,size:n,unit:r}){let[,i]=(e?.box??t).getSize(new X).toArray().sort((e,t)=>t-e);return Math.min(jE.ofSize*n,Math.max(jE.ofHeight*i,jE.least*r))}function VE(e,{arrows:t},n){if(n===0)return[];let r=WE(t.map(({v:e})=>e));return GE(e,t.filter(({v:e})=>h(Math.hypot(...e),r)>0)).map(({body:t,at:r,v:i})=>{let a=new X(...i),o=HE(e,t,r);return{body:t,from:o,to:o.clone().addScaledVector(a,n)}})}function HE({base:e,report:t},n,r){let i=new X(...r);if(!e)return i;let a=e.report.bodies[n].skeleton.findIndex(t=>e.same(new X(...t),i));return a<0?i:new X(...t.bodies[n].skeleton[a])}function UE(e,t,n){return e.report.joints.flatMap(r=>{let i=r.body_i===t?r.at_i:r.body_j===t?r.at_j:void 0;return!i||r.kind!==`revolute`||r.hinge||!e.same(new X(...i),n)?[]:Vw(e,r).map(n=>e.placeInto(t,e.worldAt(r.body_i,n,0)))})[0]?.clone()??n}function WE(e){return Math.max(0,...e.map(e=>Math.hypot(...e)))}function GE(e,t){let n=[];return t.filter(({body:t,at:r,v:i,turn:a})=>{let o={place:e.worldAt(t,new X(...r),0),v:e.alongAt(t,new X(...i),0),turn:e.alongAt(t,new X(...a),0)},s=(e,t)=>e.distanceTo(t)<=IE*e.length();return!n.some(({place:t,v:n,turn:r})=>t.distanceTo(o.place)<IE*e.size&&s(n,o.v)&&s(r,o.turn))&&(n.push(o),!0)})}var KE=7,qE=2.2,JE=1.6,YE=(e,t,{distance:n})=>{if(n===void 0)return[];let{name:r,from:i,to:a}=e.report.distances[n],o=t.unit,{label:s}=t.palette,[c,l]=[i,a].map(({at:e})=>new X(...e)),u=e=>[e.at(i.body,c),e.at(a.body,l)],d=Math.max(...e.moments.map(t=>XE(u(e.frame(t)))).filter(Number.isFinite),o),f=new X(0,1,0),p=DE(t.line([f.clone().multiplyScalar(-d/2),f.clone().multiplyScalar(d/2)],s,JE,{dashed:!0,over:!0}),yE.dimension),m=[0,1].map(()=>CE(t,new X(0,-2*qE*o,0),new X,{head:qE*o,shaft:{pixels:JE}},s,yE.dimension)),h=[0,1].map(()=>DE(t.line([new X,f.clone().multiplyScalar(8*o)],s,1,{over:!0}),yE.dimension)),g=new cf().add(p,...m.map(e=>new cf().add(e)),...h);return[{object:g,follow:t=>{let[n,r]=u(t),i=XE([n,r]);if(g.visible=i>0,!g.visible)return;let a=r.clone().sub(n).normalize(),s=ZE(e,n.clone().lerp(r,.5),a),[c,l]=[n,r].map(e=>e.clone().addScaledVector(s,KE*o));MC(p,c,l),p.scale.y/=d,jC(g.children[1],c,a.clone().negate()),jC(g.children[2],l,a),h.forEach((e,t)=>jC(e,[n,r][t],s))},part:{kind:`distance`,index:n,name:r,about:`measured distance`},overlay:!0}]};function XE([e,t]){return e.distanceTo(t)}function ZE(e,t,n){let r=t.sub(e.centre);if(!e.plane)return bC(r,n);let i=e.plane.clone().cross(n);return i.dot(r)<0?i.negate():i}var QE=class extends Am{radius;height;turns;constructor(e,t,n){super(),this.radius=e,this.height=t,this.turns=n}getPoint(e,t=new X){let n=2*Math.PI*this.turns*e;return t.set(this.radius*Math.cos(n),this.height*e,this.radius*Math.sin(n))}},$E=[`rod`,`cylinder`,`damper`,`spring`,`coilover`];function eD(e){return $E.find(t=>t===e)}var tD=.72,nD={radius:1.75,collar:2,collarHeight:1.1,piston:.8,neck:.9,neckLength:1.7},rD=.75,iD={radius:3.2,wire:.55,turns:6.5,seat:3.9,seatHeight:.7,from:.06,to:.66},aD={body:1.7,rod:.7,bodyFrom:.5,rodTo:.6};function oD(e,t,n,r=.6*n){switch(t){case`rod`:return cD(e);case`cylinder`:return lD(e,1,r);case`damper`:return lD(e,rD,r);case`spring`:return uD(e,n,!1);case`coilover`:return uD(e,n,!0)}}var sD=(e,t,n)=>{let r=e.disc(new X,new X(0,1,0),1,1,n);return r.scale.set(t,1,t),r};function cD(e){let t=sD(e,tD*e.unit,e.palette.rod);return{object:t,span:(e,n)=>void MC(t,e,n)}}function lD(e,t,n){let r=t*e.unit,{rod:i,steel:a}=e.palette,[o,s,c]=[nD.neck,nD.radius,nD.collar].map(t=>sD(e,t*r,i)),l=sD(e,nD.piston*r,a);return{object:new cf().add(o,s,c,l),span:(e,t)=>{let i=t.clone().sub(e).normalize(),a=t=>e.clone().addScaledVector(i,t),u=Math.max(n,2*nD.neckLength*r);MC(o,e,a(nD.neckLength*r)),MC(s,a((nD.neckLength-.1)*r),a(u)),MC(c,a(u-nD.collarHeight*r/2),a(u+nD.collarHeight*r/2)),MC(l,a(u),t)}}}function uD(e,t,n){let r=e.unit,{rod:i,steel:a}=e.palette,o=Math.max((iD.to-iD.from)*t,r),s=new QE(iD.radius*r,o,iD.turns),c=e.mesh(new eg(s,240,iD.wire*r,8).translate(0,-o/2,0),i),l=[0,1].map(()=>sD(e,iD.seat*r,i)),[u,d]=[sD(e,aD.body*r,i),sD(e,(n?aD.rod:tD)*r,a)];return{object:new cf().add(c,...l,d,...n?[u]:[]),span:(e,t)=>{let i=n=>e.clone().lerp(t,n),a=iD.seatHeight*r/2/Math.max(e.distanceTo(t),Number.MIN_VALUE);MC(c,i(iD.from),i(iD.to)),c.scale.y/=o,[iD.from,iD.to].forEach((e,t)=>MC(l[t],i(e-a),i(e+a))),MC(d,e,i(n?aD.rodTo:1)),MC(u,i(aD.bodyFrom),t)}}}var dD=1.25,fD={radius:1.15,pin:.62,height:1,pinHeight:1.1},pD={radius:1.5,length:2.2,pin:.9,pinLength:3.4},mD={ofMean:.62,ofLeast:.9},hD=.95,gD=(e,t,n)=>{let r=eD(n.draw)??(n.kind===`leg`?`cylinder`:`rod`),i=n.kind===`revolute_spherical`&&n.axis?new X(...n.axis):void 0;return[_D(e,t,r,{body:n.body_i,at:n.at_i},{body:n.body_j,at:n.at_j},i)]};function _D(e,t,n,r,i,a){let{plane:o}=e,[s,c]=vD(e,n,r,i),l=[s,c].map(({at:e})=>new X(...e)),u=e.moments.map(t=>e.worldAt(s.body,l[0],t).distanceTo(e.worldAt(c.body,l[1],t))).filter(Number.isFinite),d=Math.min(...u,1/0),f=u.reduce((e,t)=>e+t,0)/(u.length||1),p=Math.min(mD.ofMean*f,Math.max(mD.ofLeast*d-t.unit,.35*f)),{object:m,span:h}=oD(t,n,u[0]??f,p),g=[0,1].map(e=>o?yD(t):a&&e===0?bD(t):t.ball(new X,dD*t.unit,t.palette.steel)),_=o?.clone().multiplyScalar((Math.max(e.layerOf(s.body),e.layerOf(c.body))+hD)*e.pitch),v=new cf().add(m,...g);return{object:v,follow:e=>{if(v.visible=e.visible(s.body)&&e.visible(c.body),!v.visible)return;let t=[e.at(s.body,l[0]),e.at(c.body,l[1])];if(_)for(let e of t)e.add(_);h(t[0],t[1]);let n=t[1].clone().sub(t[0]);g.forEach((r,i)=>{o?jC(r,t[i],o):a&&i===0?NC(r,t[i],e.along(s.body,a),n):r.position.copy(t[i])})}}}function vD(e,t,n,r){if(t!==`coilover`&&t!==`spring`)return[n,r];let i=({body:t,at:n})=>e.worldAt(t,new X(...n),0).dot(e.up);return i(n)<i(r)?[r,n]:[n,r]}function yD(e){let t=e.unit,[n,r]=[new X,new X(0,1,0)];return new cf().add(e.disc(n,r,fD.radius*t,fD.height*t,e.palette.rod),e.disc(new X(0,.2*t,0),r,fD.pin*t,fD.pinHeight*t,e.palette.steel))}function bD(e){let t=e.unit,[n,r]=[new X,new X(0,1,0)];return new cf().add(e.disc(n,r,pD.radius*t,pD.length*t,e.palette.rod),e.disc(n,r,pD.pin*t,pD.pinLength*t,e.palette.steel))}function xD(e,t){let{distances:n,wheels:r}=e.report;return n.flatMap(({name:n,from:i,to:a,draw:o},s)=>{let c=i.body===0!=(a.body===0),l=eD(o)??(c&&r.length>0?`coilover`:void 0);return l?[{..._D(e,t,l,i,a),part:{kind:`distance`,index:s,name:n,about:`measured distance, drawn as a ${l}`}}]:[]})}function SD(e){let t=e.travel,n=t.filter(Number.isFinite);if(n.length!==0)return{curve:t,low:n.reduce((e,t)=>Math.min(e,t)),high:n.reduce((e,t)=>Math.max(e,t)),onwards:n[n.length-1]>=n[0]}}var CD=.2;function wD(e,t,n,r,[i,a]){let o=t-e;if(o>2*Math.PI-CD)return{radius:i,from:.5,to:5.4,heads:n?`last`:`first`};let s=Math.min(Math.max(i,o>0?r/o:a),a),c=Math.max(0,(r/s-o)/2);return{radius:s,from:e-c,to:t+c,heads:`both`}}function TD(e,t,n){let r=Math.max(0,(n-(t-e))/2);return[e-r,t+r]}function ED(e,t,n){let r=e.clone().addScaledVector(t,-e.dot(t));return r.length()>n?r.normalize():void 0}var DD=9,OD=2.6,kD=[4.4,8],AD=2.6,jD={slide:4.2,jack:5.4,leg:3.6,point:3.6,hinge:3.2},MD=.36,ND=.55,PD=(e,t)=>e.report.drivers.flatMap((n,r)=>{let i=SD(n),a=i&&FD(e,t,n,i);if(!a)return[];let o={kind:`driver`,index:r,name:n.name,about:n.law};return[{...a,part:o,overlay:!0}]});function FD(e,t,n,r){if(n.joint===null)return n.point?VD(e,t,n,r):void 0;let i=e.report.joints[n.joint];return n.turns?i.axis?ID(e,t,i,r):void 0:e.slideOf(n.joint)?RD(e,t,i,n.joint):BD(e,t,i,r)}function ID(e,t,n,{curve:r,low:i,high:a,onwards:o}){let s=t.unit,c=n.body_j===0,[l,u]=c?[n.body_j,n.body_i]:[n.body_i,n.body_j],d=new X(...c?n.at_j:n.at_i),f=new X(...n.axis),p=Math.max(0,r.findIndex(Number.isFinite)),m=c?e.into(l,e.alongAt(n.body_i,f,p),p):f.clone();c&&m.negate();let h=e.worldAt(l,d,p),g=e.shapePoints(u).map(t=>ED(e.into(l,e.worldAt(u,t,p).sub(h),p),m,2*s)).find(e=>e!==void 0),_=r[p],v=wD(i-_,a-_,o,DD*s,[kD[0]*s,kD[1]*s]),y=new vC(d.clone().add(LD(e,l,m)),m,g??yC(m)),b=OD*s,x=.8*b/v.radius,{driver:S}=t.palette,[C,w]=[v.heads===`last`?v.from:v.from+x,v.heads===`first`?v.to:v.to-x],T=new cf().add(t.line(TE(v.radius,C,w),S,AD,{over:!0}));return v.heads!==`first`&&T.add(EE(t,v.radius,v.to,1,b,S)),v.heads!==`last`&&T.add(EE(t,v.radius,v.from,-1,b,S)),T.applyMatrix4(y.matrix()),{body:l,object:DE(T,yE.driver)}}function LD(e,t,n){if(e.plane)return e.lift(t,e.topLayer+2);let r=e.into(t,e.reader).dot(n)<0?-1:1;return n.clone().multiplyScalar(r*jD.hinge*e.unit)}function RD(e,t,n,r){let i=e.slideOf(r);if(i.low>i.high)return;let a=zD(e,i.rail,i.axis),o=i.place.clone().addScaledVector(a,(n.draw?jD.jack:jD.slide)*t.unit);return o.add(e.lift(i.rail,e.topLayer+1)),{body:i.rail,object:HD(t,o,i.axis,TD(i.low,i.high,DD*t.unit))}}function zD(e,t,n){return e.plane?e.into(t,e.plane).cross(n):bC(e.into(t,e.up),n)}function BD(e,t,n,{low:r,high:i}){let[a,o]=TD(r,i,DD*t.unit),s=(o-a)/2,c=HD(t,new X,new X(0,1,0),[-s,s]),[l,u]=[new X(...n.at_i),new X(...n.at_j)];return{object:c,follow:r=>{let[i,a]=[r.at(n.body_i,l),r.at(n.body_j,u)],o=a.clone().sub(i).normalize(),s=i.clone().lerp(a,ND),d=s.clone().sub(e.centre),f=(e.plane??(e.vehicle?e.vehicle.forward:e.reader)).clone().cross(o).normalize();f.dot(d)<0&&f.negate(),c.visible=r.visible(n.body_i)&&r.visible(n.body_j),c.visible&&jC(c,s.addScaledVector(f,jD.leg*t.unit),o)}}}function VD(e,t,n,{curve:r,low:i,high:a}){let{body:o,at:s}=n.point;if(!n.along)return;let c=new X(...n.along),l=new X(...s),u=e.report.wheels.find(({centre:e})=>e.body===o),d=new cf().add(HD(t,new X,c,TD(i,a,DD*t.unit)));return{object:d,follow:n=>{if(d.visible=n.visible(o),!d.visible)return;let i=u?n.along(o,new X(...u.axis)).multiplyScalar(MD*u.radius):zD(e,0,c).multiplyScalar(jD.point*t.unit);d.position.copy(n.at(o,l)).addScaledVector(c,-k(r,n.step)).add(i)}}}function HD(e,t,n,[r,i]){let a=e=>t.clone().addScaledVector(n,e);return CE(e,a(r),a(i),{head:OD*e.unit,shaft:{pixels:AD}},e.palette.driver,yE.driver,!0)}function UD(e,t){let n=e.shapePoints(t);if(n.length<2)return[];let r=e.report.wheels.find(({centre:e})=>e.body===t);if(r)return WD(n,new X(...r.centre.at),new X(...r.axis));if(n.length===2)return[[n[0],n[1]]];let i=KD(n),a=n.map(e=>i.to(e)),o=xC(a).map(e=>a.indexOf(e));if(o.length<3){let[e,t]=EC(n,(e,t)=>e.distanceTo(t));return[[e,t]]}let s=o.map((e,t)=>[n[e],n[o[(t+1)%o.length]]]),c=n.flatMap((e,t)=>o.includes(t)?[]:[[e,n[GD(a,o,a[t])]]]);return[...s,...c]}function WD(e,t,n){let r=e.reduce((e,t)=>e.add(t),new X).divideScalar(e.length),i=t.clone().addScaledVector(n,r.sub(t).dot(n));return e.map(e=>[i,e])}function GD(e,t,[n,r]){let i=t=>Math.hypot(e[t][0]-n,e[t][1]-r);return t.reduce((e,t)=>i(t)<i(e)?t:e)}function KD(e){let[t,n]=EC(e,(e,t)=>e.distanceTo(t)),r=n.clone().sub(t),i=e.map(e=>r.clone().cross(e.clone().sub(t))).reduce((e,t)=>t.length()>e.length()?t:e);return i.length()>1e-6*r.lengthSq()?new vC(t,i,r):new vC(t,yC(r),r)}function qD(e,t,n,r){let[i,a]=[e,t].map(e=>e.shapePoints(n));return i.length!==a.length||e.moments.some(o=>i.some((i,s)=>e.worldAt(n,i,o).distanceTo(t.worldAt(n,a[s],o))>r))}var JD=2e-4,YD=2,XD={width:5,opacity:.75},ZD=(e,t)=>{let{former:n,report:r}=e;if(!n)return[];let i=JD*e.size,a=r.bodies.flatMap(({name:r},a)=>{if(a===0||!qD(e,n,a,i))return[];let o=UD(n,a);if(o.length===0)return[];let s=n.lift(a,n.topLayer+2),c=new cf().add(...o.flatMap(([e,n])=>eO(t,e.clone().add(s),n.clone().add(s))));return[{object:c,follow:({step:e})=>{let t=n.poseAt(a,e);c.visible=t!==void 0,t&&(c.position.copy(t.place),c.quaternion.copy(t.turn))},part:{kind:`mark`,index:a,name:r,about:`former design`},overlay:!0}]}),o=n.report.joints.flatMap((r,a)=>{if(r.kind!==`distance`&&r.kind!==`leg`||!e.moments.some(t=>$D(e,n,a,t)>i))return[];let{object:o,follow:s}=QD(t,n,r);return[{object:o,follow:s,part:{kind:`mark`,index:a,name:r.name,about:`former design`},overlay:!0}]});return[...a,...o]};function QD(e,t,n){let[r,i]=[new X(...n.at_i),new X(...n.at_j)],a=e=>[t.worldAt(n.body_i,r,e),t.worldAt(n.body_j,i,e)],o=t.moments.map(e=>a(e)[0].distanceTo(a(e)[1])).filter(Number.isFinite),s=Math.max(...o,0),c=new cf().add(...eO(e,new X(0,-s/2,0),new X(0,s/2,0))),l=new cf().add(c),u=t.lift(0,t.topLayer+2);return{object:l,follow:({step:e})=>{let[t,n]=a(e).map(e=>e.add(u));l.visible=Number.isFinite(t.x+n.x),l.visible&&(MC(c,t,n),c.scale.y/=s||1)}}}function $D(e,t,n,r){let[i,a]=[e,t].map(e=>{let{body_i:t,body_j:i,at_i:a,at_j:o}=e.report.joints[n];return[e.worldAt(t,new X(...a),r),e.worldAt(i,new X(...o),r)]});return Math.max(i[0].distanceTo(a[0]),i[1].distanceTo(a[1]))}function eO(e,t,n){let{view:r,former:i}=e.palette;return[DE(e.line([t,n],r,XD.width,{opacity:XD.opacity,over:!0}),yE.casing),DE(e.line([t,n],i,YD,{dashed:!0,over:!0}),yE.former)]}function tO({joints:e,couplers:t}){let n=t.flatMap(({terms:e})=>e.filter(({turns:e})=>e).map(({joint:e})=>e));return new Set(n.filter(t=>e[t]?.kind===`revolute`))}function nO({couplers:e}){return new Set(e.filter(({kind:e})=>e===`rack`).flatMap(({terms:e})=>e.filter(({turns:e})=>!e).map(({joint:e})=>e)))}var rO={height:4,width:2.5,head:.75,eye:1.35,thickness:.5,line:3.75},iO=.8;function aO(e,t,{at:n,radius:r,front:i}){let{plane:a,up:o,pitch:s,topLayer:c,large:l,unit:u}=e,d=r*(l?iO:1),f=i?(c+1)*s:-.4*u,p=new vC(n.clone().addScaledVector(a,f),a,o.clone().cross(a)),[m,h,g]=[rO.height*d,rO.width*d,rO.head*d],_=[[-g,0],[-h,-m],[h,-m],[g,0]],v=rO.line*d;return[t.slab(_,p,rO.thickness*u,t.palette.ground),t.slab(CC([[0,0,rO.eye*d]]),p,rO.thickness*u,t.palette.ground),t.hatchLine(p.from([-v,-m]),p.from([v,-m]),p.y.clone().negate(),d)]}var oO=3.6,sO=5.4,cO=.72,lO={aside:2.1,plate:7.4},uO={aside:1.35,thickness:.55,eye:1.5,width:1.6},dO=[1.9,1],fO=6,pO=1.15;function mO(e,t,n){let r=pO*n.radius,i=n.form===`lug`?cO:1,a=n.form===`fold`?lO:{aside:uO.aside,plate:sO},o=n.axis,s=wO(e,n),c=gO(n,s,i*oO*r,a.plate*r),l=CC([[0,0,uO.eye*r],[-uO.width*r,-c,0],[uO.width*r,-c,0]]);return[...[-1,1].map(e=>{let r=new vC(n.at.clone().addScaledVector(o,e*a.aside*t.unit),o,s.clone().cross(o).negate()),i=r.y.dot(s)<0?l:l.map(([e,t])=>[-e,-t]);return t.slab(i,r,uO.thickness*t.unit,t.palette.ground)}),t.footPlate(n.at.clone().addScaledVector(s,c),s,o,i*a.plate*r)]}function hO(e,t,n){let r=pO*n.radius,i=wO(e,n),a=n.at.clone().addScaledVector(i,gO(n,i,oO*r,sO*r));return[t.cylinder(a,n.at.clone().addScaledVector(i,.4*r),dO[0]*r,dO[1]*r,t.palette.ground),t.footPlate(a,i,void 0,sO*r)]}function gO({clear:e,radius:t},n,r,i){let a=e?.(n,.75*i)??0;return a>r-t?Math.min(a+t,fO*r):r}var _O=[`revolute`,`inline`,`cylindrical`],vO=[`spherical`,`universal`,`constant_velocity`,`distance`,`leg`,`point_coincident`];function yO(e,t){let n=ZC(e,0),r=[];for(let t of bO(e))r.some(({at:n})=>n.distanceTo(t.at)<.001*e.size)||r.push(t);return r.map(r=>{let i=e.plane?aO(e,t,r):r.axis?mO(e,t,r):hO(e,t,r);return{body:0,object:new cf().add(...i),part:n,detail:r.radius}})}function bO(e){let{report:t}=e,n=tO(e.report),r=e=>t.joints.some(({curve:t,body_i:n})=>t&&n===e),i=t.joints.flatMap((t,i)=>{let{body_i:a,body_j:o,kind:s}=t;if(a!==0&&o!==0||n.has(i))return[];let c=_O.includes(s);if(!c&&!vO.includes(s)||(s===`cylindrical`||s===`inline`)&&!(e.plane&&SO(e,t)))return[];let[l,u,d]=a===0?[o,t.at_i,t.at_j]:[a,t.at_j,t.at_i],f=e.worldAt(0,new X(...u),0),p=new X(...d),m=c&&t.axis?e.alongAt(t.body_i,new X(...t.axis),0).normalize():void 0,h=e.radiusAt(l,p),g=s===`distance`||s===`leg`,_=m?Vw(e,t).map(t=>e.worldAt(a,t,0)):[f],v=e.shapePoints(l).map(t=>e.worldAt(l,t,0)).filter(t=>!m||t.clone().sub(f).cross(m).length()>.002*e.size),y=t.hinge?`lug`:Iw(e,l)?`fold`:void 0;return _.map(t=>({at:t,axis:m,radius:h,form:y,clear:DO(e,l,t),front:r(l),towards:g?e.worldAt(l,p,0):xO(v,t)}))}),a=t.wheels.length===0?[]:t.distances.flatMap(({from:t,to:n})=>{if(t.body!==0&&n.body!==0)return[];let[r,i]=t.body===0?[t,n]:[n,t],[a,o]=[r,i].map(t=>e.worldAt(t.body,new X(...t.at),0));return[{at:a,towards:o,radius:e.unit,front:!1}]});return[...i,...a]}var xO=(e,t)=>e.length>0?e.reduce((e,t)=>e.add(t),new X).divideScalar(e.length):t.clone(),SO=(e,{axis:t,body_i:n})=>t!==null&&Math.abs(e.alongAt(n,new X(...t),0).dot(e.plane))>.9,CO=.25;function wO(e,{at:t,axis:n,towards:r}){let i=t.clone().sub(r);i.length()<1e-6*e.size&&i.copy(e.up).negate(),i.normalize();let a=[0,1,2].flatMap(e=>[1,-1].map(t=>new X().setComponent(e,t))),o=t=>t.dot(i)+(t.dot(e.up)<-.5?CO:0),s=a.filter(e=>!n||Math.abs(e.dot(n))<.6).reduce((e,t)=>o(t)>o(e)?t:e);return n?s.addScaledVector(n,-s.dot(n)).normalize():s}var TO=3e3,EO=8;function DO(e,t,n){let{mesh:r}=e.report.bodies[t];if(!r)return;let i=3*Math.max(1,Math.ceil(r.positions.length/3/TO)),a=Array.from({length:Math.floor(r.positions.length/i)},(e,t)=>new X().fromArray(r.positions,t*i));return(r,i)=>e.moments.filter((e,t)=>t%EO===0).flatMap(i=>a.map(r=>e.worldAt(t,r,i).sub(n)).map(e=>[e.dot(r),e.clone().cross(r).length()])).reduce((e,[t,n])=>n<i&&t>e?t:e,0)}var OO=.01,kO={round:2.5,thickness:.6,opacity:.28};function AO(e,t){let{report:n,plane:r,vehicle:i}=e;if(r||i||n.wheels.length>0||n.couplers.length>0)return[];let a=e.placesOf(0).flatMap(t=>jO(e,t));if(a.length<2)return[];let{ground:o}=t.palette,s=(...t)=>({body:0,object:new cf().add(...t),part:ZC(e,0)});if(a.length===2)return[s(t.line(a,o,2,{dashed:!0}))];let[c,l]=[a[1].clone().sub(a[0]),a.slice(2).map(e=>e.clone().sub(a[0]))],u=l.map(e=>c.clone().cross(e)).reduce((e,t)=>t.length()>e.length()?t:e,new X);if(u.length()<OO*e.size*c.length())return[s(t.line(a,o,2,{dashed:!0}))];let d=new vC(a[0],u);if(a.some(t=>Math.abs(t.clone().sub(a[0]).dot(d.normal))>OO*e.size))return[];let f=xC(a.map(e=>d.to(e))),p=CC(f.map(([e,n])=>[e,n,kO.round*t.unit])),m=[...f,f[0]].map(e=>d.from(e));return[s(t.slab(p,d,kO.thickness*t.unit,o,[],{opacity:kO.opacity}),t.line(m,o,1.5,{dashed:!0}))]}function jO(e,t){let n=e.jointsOf(0).find(({joint:n,at:r})=>e.same(r,t)&&Iw(e,n.body_i||n.body_j));return n?.axis?[-1,1].map(r=>t.clone().addScaledVector(n.axis.clone().normalize(),r*Rw.half*e.unit)):[t]}var MO=3,NO=.52,PO={rings:4,radius:2.75,less:.45,thickness:.75,apart:1.15,from:.9},FO=.17,IO=.62,LO=(e,t,n)=>{let r=RO(e,n),[i,a]=[new X(...n.at_i),new X(...n.at_j)];if(e.large)return[SA(n.body_i,t.ball(i,.6*t.unit,t.palette.steel))];let o=(t,n)=>t??e.into(n,new X(1,0,0)),s=n.axis?new X(...n.axis):void 0,c=n.axis2??n.axis_j,l=Uw(e,n.body_i,i,o(s?.clone().negate(),n.body_i)),u=Uw(e,n.body_j,a,o(c?new X(...c):void 0,n.body_j)),d=t.mesh(new Qh(MO*r,28,14,0,2*Math.PI,0,NO*Math.PI),t.body(n.body_i),{open:!0}),f=Array.from({length:PO.rings},(e,n)=>t.disc(a.clone().addScaledVector(u,(PO.from+PO.apart*n)*r),u,(PO.radius-PO.less*n)*r,PO.thickness*r,t.palette.rubber));return[SA(n.body_i,jC(d,i,l)),SA(n.body_j,...f)]};function RO(e,t){let n=e.radiusOf(t),r=Math.min(...e.report.wheels.map(({radius:e})=>e));return Number.isFinite(r)?Math.max(n,Math.min(FO*r,IO*e.roomOf(t))/MO):n}var zO=.4;function BO(e,t){let n=e.length,r=e.flatMap((r,i)=>{if(!t&&(i===0||i===n-1))return[];let[a,o]=[e[(i+n-1)%n],e[(i+1)%n]],[s,c,l]=[KO(a,r),KO(r,o),KO(a,o)],u=Math.abs((r[0]-a[0])*(o[1]-a[1])-(r[1]-a[1])*(o[0]-a[0]));return u>0?[s*c*l/(2*u)]:[]});return Math.min(...r,1/0)}function VO(e,t,n){return Math.min(n,zO*BO(e,t))}function HO(e,t,n){let r=e.length;return e.map((i,a)=>{let o=e[n?(a+r-1)%r:Math.max(0,a-1)],s=e[n?(a+1)%r:Math.min(r-1,a+1)],c=KO(o,s)||1;return[i[0]-t*(s[1]-o[1])/c,i[1]+t*(s[0]-o[0])/c]})}function UO(e,t){return HO(e,Math.sign(qO(e))*t,!0)}function WO(e,t){let n=HO(e,-t,!1),r=HO(e,t,!1),i=e.length-1;return[...n,...GO(e[i],n[i],t),...r.reverse(),...GO(e[0],r[i],t)]}function GO(e,t,n){let r=Math.atan2(t[1]-e[1],t[0]-e[0]);return Array.from({length:11},(t,i)=>{let a=r+(i+1)*Math.PI/12;return[e[0]+n*Math.cos(a),e[1]+n*Math.sin(a)]})}var KO=(e,t)=>Math.hypot(e[0]-t[0],e[1]-t[1]);function qO(e){return e.reduce((t,n,r)=>{let i=e[(r+1)%e.length];return t+n[0]*i[1]-i[0]*n[1]},0)/2}var JO={cam:4.2,groove:1.6},YO={cam:1,roller:1.3,pin:3},XO=1.1,ZO={play:1.06,band:1.5},QO={radius:.8,height:1.3,part:.5},$O=1.2,ek=[1.5,1.1],tk=(e,t,n)=>{let{curve:r,body_i:i,body_j:a}=n;if(!r||r.points.length<3)return[];let o=new X(...r.normal).normalize();e.plane&&e.alongAt(i,o,0).dot(e.plane)<0&&o.negate();let s=e.lift(i),c=new vC(new X(...n.at_i).add(s),o),l=r.points.map(e=>c.to(new X(...e))),u=VO(l,r.closed,(r.closed?JO.cam:JO.groove)*t.unit),d=r.closed?nk(e,t,n,r,c,l,u):rk(e,t,n,c,l,u),f=e.into(a,e.alongAt(i,o,0)),p=new X(...n.at_j).add(e.lift(a,e.layerOf(i))),m=e.thickness,{steel:h}=t.palette;return[d,SA(a,t.disc(p,f,u,YO.roller*m,h),t.disc(p,f,Math.min(XO*t.unit,.4*u),YO.pin*m,t.body(a)))]};function nk(e,t,n,r,i,a,o){let s=e.thickness,c=n.body_i,l=e.jointsOf(c).find(e=>e.joint.kind===`revolute`),u=i.to(l?.at??new X(...n.at_i)),d=e=>i.from(e,.9*s),f=a[0],p=i.from([u[0]+QO.part*(f[0]-u[0]),u[1]+QO.part*(f[1]-u[1])]);return SA(c,t.slab(UO(a,o),i,YO.cam*s,t.body(c)),t.line([...a,...r.closed?[f]:[]].map(d),t.palette.label,$O,{dashed:!0}),t.disc(p,i.normal,QO.radius*t.unit,QO.height*s,t.palette.view))}function rk(e,t,n,r,i,a){let o=n.body_i,s=ZO.play*a,c=s+ZO.band*t.unit,l=(o===0?[]:e.placesOf(o).map(e=>r.to(e)).filter(e=>ik(i,e)>c)).map(n=>{let a=i.reduce((e,t)=>Math.hypot(t[0]-n[0],t[1]-n[1])<Math.hypot(e[0]-n[0],e[1]-n[1])?t:e),c=Math.hypot(a[0]-n[0],a[1]-n[1]),l=Math.max(0,(c-s-.75*ZO.band*t.unit)/c),u=[n[0]+l*(a[0]-n[0]),n[1]+l*(a[1]-n[1])];return t.slab(CC([[...n,ek[0]*t.unit],[...u,.7*ek[1]*t.unit]]),r,e.thickness,t.body(o))});return SA(o,t.slab(WO(i,c),r,e.thickness,t.body(o),[WO(i,s)],{edges:50}),...l)}function ik(e,[t,n]){return Math.min(...e.map(e=>Math.hypot(e[0]-t,e[1]-n)))}var ak=[1,5.2],ok=[1.65,2],sk={reach:7,line:1.3},ck=1.1,lk=2*Rw.half+.8,uk={ring:.85,dot:.28,longer:1.2},dk=.6,fk=(e,t,n,r)=>{let{steel:i,outline:a}=t.palette,{body:o,at:s,axis:c}=Bw(e,n),l=e.radiusOf(n);if(e.plane){let{pitch:r,topLayer:c}=e,u=e.into(o,e.plane),d=e=>s.clone().addScaledVector(u,e*r);if(e.large)return[SA(o,t.disc(d(c+.6),u,dk*t.unit,.2*t.unit,i))];let f=[n.body_i,n.body_j],[p,m]=f.map(t=>e.layerOf(t)).sort((e,t)=>e-t),h=f.some(t=>e.report.joints.some(({curve:e,body_i:n})=>e&&n===t))?Math.max(m,c+1):m;return[SA(o,t.disc(d((p+h)/2),u,uk.ring*l,(h-p+uk.longer)*r,i),t.disc(d(h+.62),u,uk.dot*l,.1*t.unit,a))]}if(e.large)return[SA(o,t.ball(s,dk*t.unit,i))];if(tO(e.report).has(r))return[];let u=Vw(e,n).map(t=>e.placeInto(o,e.worldAt(n.body_i,t,0))),d=n.body_j>0?n.body_j:n.body_i,f=n.hinge?u.map(e=>t.disc(e,c,ok[0]*l,ok[1]*l,t.body(d))):[],p=[n.body_i,n.body_j].some(t=>Iw(e,t));return[SA(o,...u.map(e=>t.disc(e,c,ak[0]*l,p?lk*t.unit:ak[1]*l,i)),...pk(e,t,n,u,c,l),...f,...u.filter(t=>!n.hinge&&!e.same(t,s)).map(e=>mk(t,s,e,l,t.body(o))))]};function pk({vehicle:e,report:t},n,{hinge:r},i,a,o){if(r||e||t.wheels.length>0)return[];let s=(e,t)=>e.clone().addScaledVector(a,t*sk.reach*o);return i.map(e=>n.line([s(e,-1),s(e,1)],n.palette.label,sk.line,{dashed:!0,opacity:.75}))}function mk(e,t,n,r,i){let a=n.clone().sub(t).normalize();return e.cylinder(t,n.clone().addScaledVector(a,ak[1]*r),ck*r,ck*r,i)}var hk=5.4,gk=2.6;function _k(e,t,n,r,i){let a=r.clone().sub(n).normalize(),{plane:o}=e;if(!o)return[t.footPlate(n,a.clone().negate(),void 0,hk*i),t.footPlate(r,a,void 0,hk*i)];let s=o.clone().cross(a);return[n,r].map((e,n)=>{let r=a.clone().multiplyScalar(n===0?-1:1),o=t=>e.clone().addScaledVector(s,t*(n===0?-1:1)*gk*i);return t.hatchLine(o(1),o(-1),r,i)})}var vk=[.9,11],yk=[1.75,5],bk=(e,t,n,r)=>{let i=new X(...n.axis??[0,0,1]),{plane:a}=e;if(a&&Math.abs(e.alongAt(n.body_i,i,0).dot(a))>.9)return fk(e,t,n,r);let o=e.slideOf(r),s=e.radiusOf(n);if(!o)return[];let c=Math.max(0,o.high-o.low),l=Math.max(vk[1]*s,c+2*yk[1]*s),u=o.place.clone().addScaledVector(o.axis,c>0?(o.low+o.high)/2:0).add(e.lift(o.rail)),d=e=>u.clone().addScaledVector(o.axis,e*l),f=e.into(o.block,e.alongAt(o.rail,o.axis,0));return[SA(o.rail,t.disc(u,o.axis,vk[0]*s,l,t.palette.steel),...o.rail===0?_k(e,t,d(-.5),d(.5),s):[]),SA(o.block,t.disc(o.blockPlace.clone().add(e.lift(o.block)),f,yk[0]*s,yk[1]*s,t.body(o.block)))]};function xk(e,t,n,r,i){if(n.low>n.high)return[];let a=t.unit,o=e.plane.clone().cross(n.axis).normalize(),s=(t,i)=>n.place.clone().addScaledVector(n.axis,t).addScaledVector(o,i*r*a).addScaledVector(e.plane,-.3*a),[c,l]=[n.low-i*a,n.high+i*a];return[t.hatchLine(s(l,1),s(c,1),o,a),t.hatchLine(s(c,-1),s(l,-1),o.clone().negate(),a)]}var Sk=.95,Ck=1.05,wk={half:2.6,thickness:1.2},Tk=4.4,Ek=(e,t,n,r)=>{if(e.plane)return Dk(e,t,n,r);let i=e.slideOf(r),a=new X(...n.axis??[0,0,1]).normalize();if(!i||i.low>i.high)return[];let o=e.radiusOf(n),s=new vC(i.place,a,i.axis),c=[[i.low,0],[i.high,0]],l=e=>CC(c.map(([t,n])=>[t,n,e*o])),u=n.axis_j?new X(...n.axis_j):e.into(i.block,e.alongAt(i.rail,a,0));return[SA(i.rail,t.slab(l(wk.half),s,wk.thickness*o,t.body(i.rail),[l(Ck)],{edges:50})),SA(i.block,t.disc(i.blockPlace,u,Sk*o,Tk*o,t.palette.steel))]},Dk=(e,t,n,r)=>{let i=e.slideOf(r);if(!i||!e.plane)return[];let{block:a,blockPlace:o,rail:s}=i,c=[s,a].map(t=>e.layerOf(t)),l=e.into(a,e.plane),u=o.clone().add(e.lift(a,(c[0]+c[1])/2)),d=(Math.abs(c[0]-c[1])+1.3)*e.pitch,f=SA(a,t.disc(u,l,Sk*t.unit,d,t.palette.steel));return s===0?[SA(0,...xk(e,t,i,1.2,2)),f]:[f]},Ok={radius:.6,room:4},kk=1.5,Ak=(e,t,n,r)=>{let i=new X(...n.axis??[0,0,1]),{plane:a}=e;if(a&&Math.abs(e.alongAt(n.body_i,i,0).dot(a))>.9)return fk(e,t,n,r);if(a)return Dk(e,t,n,r);let o=e.slideOf(r);if(!o||o.low>o.high)return[];let s=e.radiusOf(n),c=[o.low-Ok.room*s,o.high+Ok.room*s].map(e=>o.place.clone().addScaledVector(o.axis,e));return[SA(o.rail,t.cylinder(c[0],c[1],Ok.radius*s,Ok.radius*s,o.rail===0?t.palette.ground:t.palette.steel),...o.rail===0?_k(e,t,c[0],c[1],s):[]),SA(o.block,t.ball(o.blockPlace,kk*s,t.body(o.block)))]},jk=2.1,Mk=(e,t,n)=>{let{body:r,at:i}=Bw(e,n),a=t.mesh(new Jh(jk*e.radiusOf(n)),t.palette.steel,{edges:20});return a.position.copy(i).add(e.lift(r,e.topLayer+1)),[SA(r,a)]},Nk={side:10,thickness:.25,room:3,opacity:.5},Pk=1.2,Fk=[2.2,.8],Ik=(e,t,n,r)=>{let i=n.kind===`planar`;if(e.plane&&!i)return Dk(e,t,n,r);let a=e.radiusOf(n),o=new X(...n.axis??[0,0,1]).normalize(),s=new X(...n.at_j),c=new vC(new X(...n.at_i),o,n.axis2&&n.kind===`planar`?new X(...n.axis2):void 0),l=Rk(e,n,s).map(e=>c.to(e)),[u,d]=[0,1].map(e=>l.map(t=>t[e])),[[f,p],[m,h]]=[u,d].map(e=>{let[t,n]=[Math.min(...e),Math.max(...e)],r=Math.max(Nk.side/2*a,(n-t)/2+Nk.room*a);return[(t+n)/2-r,(t+n)/2+r]}),g=[[f,m],[p,m],[p,h],[f,h]],_=t.slab(g,c,Nk.thickness*a,t.body(n.body_i),[],{opacity:Nk.opacity,edges:20}),v=n.axis_j?new X(...n.axis_j):e.into(n.body_j,e.alongAt(n.body_i,o,0)),y=i?t.disc(s,v,Fk[0]*a,Fk[1]*a,t.body(n.body_j)):t.ball(s,Pk*a,t.palette.steel),b=n.body_i===0?Lk(e,t,c,g,a):[];return[SA(n.body_i,_,...b),SA(n.body_j,y)]};function Lk({plane:e},t,n,r,i){let a=r.map(e=>n.from(e)),o=a.map((e,t)=>[e,a[(t+1)%a.length]]);if(!e)return o.map(([e,r])=>t.hatchLine(e,r,r.clone().sub(e).cross(n.normal),i));let s=o.find(([t,n])=>Math.abs(n.clone().sub(t).normalize().dot(e))<.1);return s?[t.hatchLine(s[0],s[1],n.normal.clone().negate(),i)]:[]}function Rk(e,{body_i:t,body_j:n,at_i:r},i){let a=e.moments.map(r=>e.placeInto(t,e.worldAt(n,i,r),r)).filter(({x:e,y:t,z:n})=>Number.isFinite(e+t+n));return a.length>0?a:[new X(...r)]}var zk={radius:1.15,length:26},Bk={radius:1.25,pitch:1.1,width:1},Vk=16,Hk=[2.9,2.4],Uk=new X(0,1,0),Wk=(e,t,n)=>{let{steel:r,outline:i}=t.palette,a=e.radiusOf(n),o=new X(...n.axis??[0,0,1]).normalize(),s=new X(...n.at_i),c=new X(...n.at_j),l=e.moments.map(t=>e.placeInto(n.body_i,e.worldAt(n.body_j,c,t),t).sub(s).dot(o)).filter(Number.isFinite),[u,d]=[Math.min(0,...l),Math.max(0,...l)],f=Math.max((zk.length*a-(d-u))/2,Hk[1]*a),[p,m]=[u-f,d+f].map(e=>s.clone().addScaledVector(o,e)),h=p.distanceTo(m),g=Math.max(1,Math.round(h/(Bk.pitch*a))),_=new QE(Bk.radius*a,h,g),v=new ld().setFromUnitVectors(Uk,o),y=Array.from({length:g*Vk+1},(e,t)=>_.getPoint(t/(g*Vk)).applyQuaternion(v).add(p)),b=t.mesh(new Sm(Hk[0]*a,Hk[0]*a,Hk[1]*a,6),t.body(n.body_j),{edges:30,facets:!0}),x=n.axis_j?new X(...n.axis_j):e.into(n.body_j,e.alongAt(n.body_i,o,0));return[SA(n.body_i,t.cylinder(p,m,zk.radius*a,zk.radius*a,r),t.line(y,i,Bk.width,{opacity:.7}),...n.body_i===0?_k(e,t,p,m,a):[]),SA(n.body_j,jC(b,c,x))]},Gk=1.55,Kk=1.95,qk=.42,Jk={ball:1.45,arc:2.1,half:1.92,line:2.4},Yk=(e,t,n)=>{let{steel:r,outline:i}=t.palette,a=e.radiusOf(n),{body:o,at:s}=Bw(e,n);if(e.large)return[SA(o,t.ball(s,.6*t.unit,r))];if(e.plane){let c=e.into(o,e.plane),l=(e.layerOf(n.body_i)+e.layerOf(n.body_j))/2,u=s.clone().addScaledVector(c,l*e.pitch),d=n.body_j,f=new X(...n.at_j),p=e.into(d,e.plane),m=new vC(f.clone().addScaledVector(p,l*e.pitch+1.6*t.unit),p,Uw(e,d,f,e.into(d,e.up))),h=Array.from({length:33},(e,t)=>{let n=Jk.half*(t/16-1);return m.from([Jk.arc*a*Math.cos(n),Jk.arc*a*Math.sin(n)])});return[SA(o,t.ball(u,Jk.ball*a,r)),SA(d,t.line(h,i,Jk.line))]}let c=n.body_i===0||n.body_j===0,l=c?0:n.body_j,u=new X(...l===n.body_j?n.at_j:n.at_i),d=e.into(l,e.up),f=c?e.into(l,e.alongAt(o,Uw(e,o,s,e.into(o,e.up)),0)).negate():Uw(e,l,u,d),p=t.mesh(new Qh(Kk*a,24,12,0,2*Math.PI,0,qk*Math.PI),t.body(l),{open:!0});return[SA(o,t.ball(s,Gk*a,r)),SA(l,jC(p,u,f))]},Xk={length:5.2,across:3.2,height:3,width:3.8},Zk={length:4.6,across:2.9},Qk=9.5,$k={aside:1.75,room:3.9},eA={outer:1.9,inner:1.35,onGround:9,onBody:7},tA={down:4.2,radius:1.2,plate:6},nA={room:4.2,aside:1.6,bar:.55},rA=(e,t,n,r)=>{let i=e.slideOf(r);if(!i)return[];let a=eD(n.draw);if(a&&a!==`rod`&&!e.plane)return[cA(e,t,n,i,a)];if(e.plane)return iA(e,t,i);let{rail:o,block:s,place:c,blockPlace:l}=i;return aA(e,i,s,l)||nO(e.report).has(r)?oA(e,t,o,c,i.axis):o>0&&aA(e,i,o,c)?oA(e,t,s,l,e.into(s,e.alongAt(o,i.axis,0))):sA(e,t,i)};function iA(e,t,n){let{rail:r,block:i,blockPlace:a,axis:o}=n,s=t.unit,c=e.into(i,e.plane),l=e.into(i,e.alongAt(r,o,0)),u=r===0,[d,f]=u?[Xk.length,Xk.across]:[Zk.length,Zk.across],p=e.report.joints.some((t,n)=>{let r=e.slideOf(n);return r!==void 0&&r.rail===i&&e.same(r.place,a)}),m=p?e.layerOf(i)-.6:u?e.layerOf(i):e.layerOf(r)+.3,h=a.clone().add(e.lift(i,m)),g=t.brick(h,l,c.clone().cross(l),[(p?Qk:d)*s,f*s,1.05*e.thickness],t.body(i));return u?[SA(0,...xk(e,t,n,$k.aside,$k.room+(p?2:0))),SA(i,g)]:[SA(i,g)]}function aA(e,{rail:t,axis:n},r,i){let a=e.into(r,e.alongAt(t,n,0));return e.shapePoints(r).filter(t=>t.clone().sub(i).cross(a).length()<.02*e.size).length>1}function oA(e,t,n,r,i){let a=t.unit,o=(n===0?eA.onGround:eA.onBody)*a,s=[t.tube(r,i,eA.outer*a,eA.inner*a,o,t.body(n))];if(n===0){let n=fA(e,i),o=r.clone().addScaledVector(n,tA.down*a);s.push(t.cylinder(r.clone().addScaledVector(n,eA.outer*a*.9),o,tA.radius*a,tA.radius*a,t.palette.ground),t.footPlate(o,n,i,tA.plate*a))}return[SA(n,...s)]}function sA(e,t,n){let{rail:r,block:i,place:a,blockPlace:o,axis:s}=n,c=t.unit,l=e.into(r,fA(e,e.alongAt(r,s,0))),u=s.clone().cross(l).normalize(),[d,f]=n.low<=n.high?[n.low,n.high]:[0,0],[p,m]=[d-nA.room*c,f+nA.room*c].map(e=>a.clone().addScaledVector(s,e)),h=p.clone().lerp(m,.5),g=p.distanceTo(m),_=r===0?[t.brick(h.clone().addScaledVector(l,1.9*c),s,l,[g,c,2.2*c],t.palette.ground),t.hatched(h.clone().addScaledVector(l,2.6*c),s,l,[g,.5*c,5*c])]:[-1,1].map(e=>{let n=u.clone().multiplyScalar(e*nA.aside*c);return t.cylinder(p.clone().add(n),m.clone().add(n),nA.bar*c,nA.bar*c,t.body(r))}),v=t=>e.into(i,e.alongAt(r,t,0));return[SA(r,..._),SA(i,t.brick(o,v(s),v(l),[Xk.length*c,Xk.height*c,Xk.width*c],t.body(i)))]}function cA(e,t,n,r,i){let[a,o]=dA(e,uA(e,n,r.rail,r),uA(e,n,r.block,r)),s=({body:t,at:n})=>e.worldAt(t,n,0).dot(e.up),[c,l]=s(a)>s(o)?[a,o]:[o,a],{object:u,span:d}=oD(t,i,e.worldAt(c.body,c.at,0).distanceTo(e.worldAt(l.body,l.at,0)));return{object:new cf().add(u),follow:e=>d(e.at(c.body,c.at),e.at(l.body,l.at))}}var lA=.001;function uA(e,t,n,r){let i=e.base??e,a=i.slideOf(e.report.joints.indexOf(t))??r,o=n===a.block,[s,c]=o?[a.blockPlace,i.into(n,i.alongAt(a.rail,a.axis,0))]:[a.place,a.axis],l=e=>new X(...e).sub(s).cross(c).length()<lA*i.size,u=i.report.bodies[n].skeleton.flatMap((t,r)=>l(t)?[new X(...e.report.bodies[n].skeleton[r])]:[]),d=e.jointsOf(n).filter(e=>e.joint!==t);return(u.length>0?u:[o?r.blockPlace:r.place]).map(t=>({body:n,at:t,held:d.some(n=>e.same(n.at,t))}))}function dA(e,t,n){let r=([t,n])=>e.worldAt(t.body,t.at,0).distanceTo(e.worldAt(n.body,n.at,0)),i=t=>(Number(t[0].held)+Number(t[1].held))*2*e.size+r(t);return t.flatMap(e=>n.map(t=>[e,t])).reduce((e,t)=>i(t)>i(e)?t:e)}function fA(e,t){let n=e.up.clone().negate(),r=[0,1,2].flatMap(e=>[1,-1].map(t=>new X().setComponent(e,t))).filter(e=>Math.abs(e.dot(t))<.6).reduce((e,t)=>t.dot(n)>e.dot(n)+1e-9?t:e);return r.addScaledVector(t,-r.dot(t)).normalize()}var pA={radius:.75,half:2.6},mA={eye:1.15,thickness:.9,arm:.7,behind:3.6},hA={units:1.8,part:.09},gA={circle:1.9,line:2},_A=(e,t,n)=>{let{steel:r,outline:i}=t.palette,a=e.radiusOf(n),o=[new X(...n.at_i),new X(...n.at_j)];if(e.large)return[SA(n.body_i,t.ball(o[0],.6*t.unit,r))];if(e.plane){let s=n.body_j,c=e.into(s,e.plane),l=Math.max(e.layerOf(n.body_i),e.layerOf(s))+.6,u=o[1].clone().addScaledVector(c,l*e.pitch),d=new vC(u.clone().addScaledVector(c,t.unit),c),f=e=>d.from([gA.circle*a*Math.cos(e),gA.circle*a*Math.sin(e)]),p=Array.from({length:49},(e,t)=>f(t*Math.PI/24)),m=[1,5,3,7].map(e=>f(e*Math.PI/4));return[SA(s,t.disc(u,c,gA.circle*a,1.2*t.unit,r),t.line(p,i,gA.line),t.lines(m,i,gA.line))]}let s=[n.body_i,n.body_j].some(t=>e.report.joints.some((n,r)=>e.slideOf(r)?.block===t))?a:Math.max(a,Math.min(hA.units*t.unit,hA.part*e.roomOf(n))),c=n.axis?new X(...n.axis):new X(0,0,1),l=n.axis2?new X(...n.axis2):e.into(n.body_j,yC(e.alongAt(n.body_i,c,0))),u=(n,i,a)=>{let o=a.clone().normalize(),c=(e,t=pA.half)=>i.clone().addScaledVector(o,e*t*s),l=bC(Uw(e,n,i,yC(o)),o),u=i.clone().addScaledVector(l,mA.behind*s),d=t.body(n),f=[-1,1].flatMap(e=>{let n=c(e,pA.half-mA.thickness/2),r=n.clone().addScaledVector(l,.55*mA.behind*s);return[t.disc(n,o,mA.eye*s,mA.thickness*s,d),t.cylinder(n,r,mA.arm*s,mA.arm*s,d),t.ball(r,mA.arm*s,d),t.cylinder(r,u,mA.arm*s,mA.arm*s,d)]});return SA(n,t.cylinder(c(-1),c(1),pA.radius*s,pA.radius*s,r),...f)};return[u(n.body_i,o[0],c),u(n.body_j,o[1],l)]},vA=[2.2,.7],yA={half:1.1,height:.3},bA={revolute:fk,spherical:Yk,universal:_A,constant_velocity:LO,cylindrical:bk,translational:rA,planar:Ik,inplane:Ik,inline:Ak,pin_in_slot:Ek,point_on_curve:tk,screw:Wk,distance:gD,leg:gD,revolute_spherical:gD,dot2:Ik,fixed:(e,t,n)=>{let r=e.radiusOf(n),i=[new X(...n.at_i),new X(...n.at_j)],a=[n.body_i,n.body_j];if(e.plane){let o=n.body_j,s=Math.max(...a.map(t=>e.layerOf(t))),c=i[1].clone().add(e.lift(o,s+.6)),l=e.into(o,e.plane),u=2*yA.half*r;return[SA(o,t.brick(c,e.into(o,e.up),l,[u,yA.height*t.unit,u],t.palette.outline))]}let o=Uw(e,n.body_j,i[1],e.into(n.body_j,e.up)),s=[e.into(n.body_i,e.alongAt(n.body_j,o,0)),o];return a.map((e,n)=>{let a=i[n].clone().addScaledVector(s[n],(n-.5)*vA[1]*r);return SA(e,t.disc(a,s[n],vA[0]*r,vA[1]*r,t.body(e),{edges:30}))})}};function xA(e,t){return e.report.joints.flatMap((n,r)=>{let i=Object.hasOwn(bA,n.kind)?bA[n.kind]:Mk,a=QC(e,r);return i(e,t,n,r).map(e=>({...e,part:a}))})}function SA(e,...t){return{body:e,object:t.length===1?t[0]:new cf().add(...t)}}var CA=1e-9;function wA(e,t,n){let r=t.map((e,t)=>n[t].clone().sub(e)),i=e.slice();if(r.every(e=>e.lengthSq()===0))return i;let a=Math.max(...t.map(e=>e.lengthSq()),1e-30);for(let n=0;n<e.length;n+=3){let o=[0,0,0],s=0;for(let i=0;i<t.length;i++){let c=(e[n]-t[i].x)**2+(e[n+1]-t[i].y)**2+(e[n+2]-t[i].z)**2,l=1/Math.max(c,CA*CA*a);s+=l,o[0]+=l*r[i].x,o[1]+=l*r[i].y,o[2]+=l*r[i].z}for(let e=0;e<3;e++)i[n+e]+=o[e]/s}return i}var TA=35,EA=6e4,DA=(e,t)=>e.report.bodies.flatMap(({mesh:n},r)=>{if(!n)return[];let i=Uint32Array.from(n.triangles),a=new lp;a.setAttribute(`position`,new Q(OA(e,r,n.positions),3)),a.setIndex(new Yf(i,1)),a.computeVertexNormals();let o={open:!0,facets:!0,edges:i.length<3*EA?TA:void 0};return[{body:r,object:t.mesh(a,t.body(r),o),part:ZC(e,r)}]});function OA(e,t,n){if(!e.base)return n;let[r,i]=[e.base,e].map(({report:e})=>e.bodies[t].skeleton.map(e=>new X(...e)));return r.length===i.length&&r.length>0?wA(n,r,i):n}var kA={from:2.2,radius:2.5,length:5.4},AA={at:2.6,radius:2.65,height:.8};function jA(e,t){let{report:n,plane:r,large:i}=e;if(r||i)return[];let a=tO(n);return n.drivers.flatMap(({joint:r,turns:i})=>{if(r===null||!i||a.has(r))return[];let o=n.joints[r];if(o.kind!==`revolute`||o.body_i!==0&&o.body_j!==0)return[];let{body:s,at:c,axis:l}=Bw(e,o),u=e.alongAt(s,l,0),d=c.clone().sub(Hw(e,s,c)).dot(l),f=Math.abs(d)>t.unit?Math.sign(d):-Math.sign(u.dot(e.reader))||1;u.multiplyScalar(f);let p=Math.min(t.unit,1.4*e.radiusOf(o)),m=Vw(e,o).map(t=>e.worldAt(o.body_i,t,0)).reduce((e,t)=>t.dot(u)>e.dot(u)?t:e),h=e=>m.clone().addScaledVector(u,e*p),g=t.cylinder(h(kA.from),h(kA.from+kA.length),kA.radius*p,kA.radius*p,t.palette.ground),_=t.disc(h(AA.at),u,AA.radius*p,AA.height*p,t.palette.driver);return[{body:0,object:new cf().add(g,_),part:ZC(e,0)}]})}var MA=2.2,NA=1.5,PA=.6,FA=1.05,IA=12,LA=(e,t,n)=>{if(!n.trace)return[];let[r,i]=n.trace,a=e.report.bodies[r],o=new X(...a.skeleton[i]),{trace:s,former:c}=t.palette,l={kind:`mark`,index:r,name:a.labels[i]||a.name,about:`path`},u=e.lift(0,e.topLayer+2),d=t=>e.worldAt(r,o,t).add(u),f=new cf,p=e.former;if(p){let e=new X(...p.report.bodies[r].skeleton[i]),n=RA(p.report.times.length,t=>p.worldAt(r,e,t).add(u));for(let e of n)f.add(DE(t.line(e,c,NA,{dashed:!0,over:!0}),yE.former))}for(let n of RA(e.report.times.length,d))f.add(DE(t.line(n,s,MA,{over:!0}),yE.trace));f.add(BA(t,zA(e.report.times).map(d).filter(VA)));let m=DE(AE(t,new Qh(FA*t.unit,20,14),s),yE.trace);return[{object:f,part:l,overlay:!0},{object:m,part:l,follow:e=>{m.visible=e.visible(r),m.visible&&m.position.copy(e.at(r,o)).add(u)},overlay:!0}]};function RA(e,t){let n=[[]];for(let r=0;r<e;r++){let e=t(r);VA(e)?n[n.length-1].push(e):n[n.length-1].length>0&&n.push([])}return n.filter(e=>e.length>1)}function zA(e){let t=e[e.length-1],n=t-e[0];if(!(n>0))return[];let r=f(n/IA),i=Math.floor(n/r+1e-6);return Array.from({length:i+1},(n,i)=>A(e,Math.min(e[0]+i*r,t)))}function BA(e,t){let n=AE(e,new Qh(PA*e.unit,14,10),e.palette.trace),r=new Yp(n.geometry,n.material,t.length);return t.forEach((e,t)=>r.setMatrixAt(t,new Nd().setPosition(e))),DE(r,yE.trace)}function VA({x:e,y:t,z:n}){return Number.isFinite(e+t+n)}var HA=3,UA={width:1.4,opacity:.7},WA=.01,GA=(e,t)=>{let{report:n,vehicle:r,large:i}=e;if(r||i||n.wheels.length>0)return[];let a=n.bodies.flatMap(({skeleton:t,roles:n},r)=>{let i=r===0?[]:e.shapePoints(r);return t.flatMap((t,a)=>{let o=new X(...t);return n[a]===`measured`&&i.some(t=>e.same(t,o))?[{body:r,at:o}]:[]})});return a.length>HA?[]:a.flatMap(({body:r,at:i})=>{let a=e.lift(0),o=RA(n.times.length,t=>e.worldAt(r,i,t).add(a));if(!o.flat().some(t=>t.distanceTo(o[0][0])>WA*e.size))return[];let s=o.map(e=>t.line(e,t.palette.trace,UA.width,{opacity:UA.opacity}));return[{body:0,object:new cf().add(...s),part:ZC(e,r)}]})},KA=.3,qA=.66;function JA(e){let t=KA*e,n=[[.86,1.05],[.95,.92],[1,.62]],r=n.map(([n,r])=>[n*e,r*t]),i=n.map(([n,r])=>[n*e,-r*t]).reverse(),a=qA*e;return[[a,t],...r,...i,[a,-t],[a,t]]}var YA=[{radius:1,side:.62,line:1.1,opacity:.55},{radius:qA,side:1,line:1.3,opacity:.7},{radius:.9,side:1.04,line:.8,opacity:.35}],XA={count:5,from:.2,side:.25,line:2.2,opacity:.28};function ZA(e,t){return e.report.wheels.map((n,r)=>({body:n.centre.body,object:QA(t,n,e.into(n.centre.body,e.up)),part:{kind:`wheel`,index:r,name:n.name,about:`road wheel`}}))}function QA(e,{centre:t,axis:n,radius:r},i){let{palette:a}=e,o=KA*r,s=new vC(new X(...t.at),new X(...n),i),c=(e,t,n)=>s.from([e*r*Math.cos(t),e*r*Math.sin(t)],n*o),l=e.lathe(s.origin,s.normal,JA(r),a.tyre,{opacity:a.glass}),u=YA.flatMap(({radius:t,side:n,line:r,opacity:i})=>[-n,n].map(n=>e.line(Array.from({length:97},(e,r)=>c(t,r*Math.PI/48,n)),a.tyre,r,{opacity:i}))),d=Array.from({length:XA.count},(e,t)=>2*Math.PI*t/XA.count).flatMap(e=>[c(XA.from,e,XA.side),c(qA,e,XA.side)]);return new cf().add(l,e.shadowOf(l),...u,e.lines(d,a.tyre,XA.line,{opacity:XA.opacity}))}var $A=[_T,DA,yO,AO,xA,_E,ZA,xD,jA,GA],ej=[ZD,LA,PD,YE,LE];function tj(e,t){return e!==void 0&&t!==void 0&&e.kind===t.kind&&e.index===t.index}var nj=1.05,rj=.55,ij=new X(.35,-.45,1),aj=1024,oj=class{object=new cf;cell;#e=[];constructor(e,t,n){let{plane:r,up:i,size:a,centre:o,report:s}=e,c=a+2*Math.max(0,...s.wheels.map(({radius:e})=>e));this.cell=f(c/5);let l=r??i,u=r?r.dot(o)-3*e.unit:sj(e)??n-.002*a,d=o.clone().addScaledVector(l,u-o.dot(l)),{light:p}=t,m=new o_(16777215,p.sun),h=i.clone().cross(l),g=r?r.clone().addScaledVector(i,.5).addScaledVector(h,-.4):ij.clone();m.position.copy(o).addScaledVector(g.normalize(),3*a),m.target.position.copy(o);let _=new Gg(16777215,p.earth,p.sky);if(_.position.copy(r??i),this.object.add(_,m,m.target,this.#t(d,l,c,r!==void 0,t)),r)return;m.castShadow=!0,m.shadow.mapSize.set(aj,aj),m.shadow.radius=3,m.shadow.bias=-5e-4,Object.assign(m.shadow.camera,{left:-c,bottom:-c,right:c,top:c,near:.1*a,far:8*a});let v=new rg({opacity:p.shadow}),y=new Lp(new Yh(12*c,12*c),v);y.quaternion.setFromUnitVectors(new X(0,0,1),l),y.position.copy(d),y.receiveShadow=!0,this.#e.push(v,y.geometry),this.object.add(y)}dispose(){for(let e of this.#e)e.dispose();this.object.traverse(e=>{e instanceof o_&&e.dispose()})}#t(e,t,n,r,i){let{cell:a}=this,o=Math.abs(t.x)<.5?new X(1,0,0):yC(t),s=t.clone().cross(o),c=2*Math.ceil((r?3:1.1)*n/a),l=t=>Math.round(e.dot(t)/a)*a,u=t.clone().multiplyScalar(e.dot(t)-.001*n).addScaledVector(o,l(o)).addScaledVector(s,l(s)),d=new Z(i.view),f=new Z(i.gridMain),p=[],m=[];for(let[t,i]of[[o,s],[s,o]])for(let o=-c/2;o<=c/2;o++)for(let s=-c/2;s<c/2;s++)for(let c of[s,s+1]){let s=u.clone().addScaledVector(i,o*a).addScaledVector(t,c*a),l=r?rj:Math.max(0,1-s.distanceTo(e)/(nj*n));p.push(s.x,s.y,s.z),m.push(...d.clone().lerp(f,l).toArray())}let h=new lp;h.setAttribute(`position`,new Q(p,3)),h.setAttribute(`color`,new Q(m,3));let g=new nm({vertexColors:!0});return this.#e.push(h,g),new mm(h,g)}};function sj(e){let t=e.report.wheels.map(({centre:t,axis:n,radius:r})=>{let i=e.alongAt(t.body,new X(...n),0),a=Math.sqrt(Math.max(0,1-i.dot(e.up)**2));return e.worldAt(t.body,new X(...t.at),0).dot(e.up)-r*a});return t.length>0?Math.min(...t):void 0}var cj=[22,34,48],lj=12,uj=2*Math.PI/lj,dj=6.2,fj=10,pj=16,mj=4;function hj(e,t,n,r=e=>dj*e.length){let i=[];for(let a of e){let e=gj(a,r(a.text)+fj,Math.atan2(a.y-n.y,a.x-n.x)).find(e=>_j(e,t)&&!i.some(t=>vj(e,t)));e&&i.push(e)}return i}function gj(e,t,n){return cj.flatMap(r=>Array.from({length:lj},(i,a)=>{let o=n+(a%2?1:-1)*Math.ceil(a/2)*uj,[s,c]=[Math.cos(o),Math.sin(o)];return{spot:e,x:e.x+s*(r+t/2*Math.abs(s)),y:e.y+c*r,width:t,height:pj}}))}function _j({x:e,y:t,width:n,height:r},i){return e-n/2>=mj&&e+n/2<=i.width-mj&&t-r/2>=i.top&&t+r/2<=i.height-mj}function vj(e,t){return Math.abs(e.x-t.x)<(e.width+t.width)/2&&Math.abs(e.y-t.y)<(e.height+t.height)/2}var yj=34,bj=`11px system-ui, sans-serif`,xj=4,Sj=60,Cj=class{element=r(`svg`,{class:`labels`,"aria-hidden":`true`});placed=[];#e=document.createElement(`canvas`).getContext(`2d`);#t=new Map;show(e,t,n,i,a){let o=e=>{let{x:n,y:r,z:o}=e.clone().project(t);return{x:(n+1)*i/2,y:(1-r)*a/2,seen:Math.abs(o)<=1&&Math.abs(n)<=1&&Math.abs(r)<=1}},s=e.flatMap(({at:e,text:t})=>{let{x:n,y:r,seen:i}=o(e);return i?[{x:n,y:r,text:t}]:[]});this.placed=hj(s.slice(0,Sj),{width:i,height:a,top:yj},o(n),e=>this.#n(e)),this.element.setAttribute(`viewBox`,`0 0 ${i} ${a}`),this.element.replaceChildren(...this.placed.map(({spot:e,x:t,y:n})=>r(`line`,{x1:e.x,y1:e.y,x2:t,y2:n})),...this.placed.map(({spot:e,x:t,y:n,width:i,height:a})=>{let o=r(`text`,{x:t,y:n});return o.textContent=e.text,r(`g`,{},r(`rect`,{x:t-i/2,y:n-a/2,width:i,height:a,rx:4}),o)}))}#n(e){let t=this.#t.get(e);if(t!==void 0||!this.#e)return t??0;this.#e.font=bj;let n=this.#e.measureText(e).width;return this.#t.set(e,n),n}};function wj(e,t,n){let r=[];return e.report.bodies.forEach(({skeleton:i,labels:a},o)=>{n!==void 0&&n!==o||!t.visible(o)||i.forEach((n,i)=>{let s=a[i]?.split(`, `)[0],c=t.at(o,new X(...n));s&&!r.some(t=>e.same(t.at,c))&&r.push({at:c,text:s})})}),r}function Tj({report:e},t,n,r){if(n===void 0)return[];let{name:i,from:a,to:o}=e.distances[n],c=e.quantities.findIndex(e=>e.name===i),[u,d]=[a,o].map(({body:e,at:n})=>t.at(e,new X(...n)));return c<0||!Number.isFinite(u.distanceTo(d))?[]:[{at:u.lerp(d,.5),text:`${i} ${s(h(r(c)),xj)} ${l(e.quantities[c].units[0])}`}]}function Ej(e,t,n){if(n.kind===`body`)return n.index===0?[]:wj(e,t,n.index);if(n.kind!==`joint`)return[];let{name:r,body_i:i,at_i:a}=e.report.joints[n.index];return t.visible(i)?[{at:t.at(i,new X(...a)),text:r}]:[]}var Dj=.6;function Oj(e,t,n){let r=[];for(let e of t){let t=r.find(({at:t})=>t.distanceTo(e.at)<n);t?e.bodies.forEach(e=>t.bodies.add(e)):r.push({at:e.at,bodies:new Set(e.bodies)})}let i=e.map(()=>0),a=e.map((e,t)=>t).slice(1).sort((t,n)=>e[n]-e[t]);for(let t of a){let n=[...new Set(r.filter(({bodies:e})=>e.has(t)).flatMap(({bodies:e})=>[...e]))].filter(e=>e>0&&e!==t),a=n.map(e=>i[e]),o=n.length>0&&n.every(n=>e[t]<Dj*e[n])?Math.max(...a)+1:1;for(;a.includes(o);)o++;i[t]=o}return i}var kj=7;function Aj(e,t){let n=e.length/kj-1,r=Math.min(Math.floor(t),n),i=jj(e,r);if(t>r&&r<n){let n=jj(e,r+1);i.place.lerp(n.place,t-r),i.turn.slerp(n.turn,t-r)}return Number.isFinite(i.place.x+i.turn.w)?i:void 0}function jj(e,t){let[n,r,i,a,o,s,c]=e.subarray(t*kj,(t+1)*kj);return{place:new X(n,r,i),turn:new ld(o,s,c,a)}}var Mj=6;function Nj(e,t,n,r){if(!t)return e;let i=t.length/Mj-1,a=Math.min(Math.floor(n),i),o=Math.min(a+1,i),[s,c,l,u,d,f]=[0,1,2,3,4,5].map(e=>{let[i,s]=[t[a*Mj+e],t[o*Mj+e]];return(i+(s-i)*Math.min(n-a,1))*r}),p=new X(u,d,f),m=p.length(),h=e.place.clone().add(new X(s,c,l));return m===0?{place:h,turn:e.turn}:{place:h,turn:new ld().setFromAxisAngle(p.divideScalar(m),m).multiply(e.turn)}}function Pj(e,t){return e?t.clone().applyQuaternion(e.turn).add(e.place):new X(NaN,NaN,NaN)}function Fj(e,t){return e?t.clone().applyQuaternion(e.turn):new X(NaN,NaN,NaN)}var Ij=.002,Lj=.999;function Rj(e,t,n){if(e.wheels.length>0||e.vehicle)return;let r=e.joints.filter(e=>e.kind===`revolute`&&e.axis).map(t=>Fj(Aj(e.bodies[t.body_i].poses,0),new X(...t.axis))).filter(({x:e})=>Number.isFinite(e)),i=r[0]?.clone().normalize();if(!i||!r.every(e=>Math.abs(e.dot(i))>Lj))return;let a=new jf().setFromPoints(t.map(e=>new X(e.dot(i),0,0)));if(!(a.max.x-a.min.x>Ij*n))return i.multiplyScalar(zj(i))}function zj({x:e,y:t,z:n}){let r=Math.max(Math.abs(e),Math.abs(t),Math.abs(n));return Math.abs(n)===r?Math.sign(n):Math.abs(t)===r?-Math.sign(t):Math.sign(e)}var Bj=new X(.75,-1,.55),Vj=[new X(-.75,-1,.55),new X(.75,1,.55),new X(-.75,1,.55)],Hj=.85,Uj=.04,Wj=.5;function Gj(e,t,n=[]){let r=r=>(1+Kj(e,r,t))*(1+Wj*n.filter(e=>e.dot(r)>0).length),i=r(Bj),a=Vj.map(r),o=Math.min(...a);return(o<Hj*i?Vj[a.indexOf(o)]:Bj).clone()}function Kj(e,t,n){let r=t.clone().normalize(),i=Uj*n,a=0;for(let t of e){let e=t.map(e=>e.clone().addScaledVector(r,-e.dot(r))),n=(e,t)=>1/(1+e.distanceToSquared(t)/i**2);for(let r=1;r<t.length;r++)for(let i=0;i<r;i++)a+=n(e[r],e[i])-n(t[r],t[i])}return a}var qj=[`translational`,`cylindrical`,`inplane`,`inline`,`pin_in_slot`],Jj=[`inplane`,`inline`,`pin_in_slot`];function Yj(e,t){if(!qj.includes(t.kind)||!t.axis||t.kind===`inline`&&e.plane&&Math.abs(e.alongAt(t.body_i,new X(...t.axis),0).dot(e.plane))>.9)return;let n={rail:t.body_i,block:t.body_j,axis:new X(...t.axis),place:new X(...t.at_i),blockPlace:new X(...t.at_j)};if(t.kind===`inplane`){let t=n.axis;n.axis=e.plane?e.into(n.rail,e.plane).cross(t).normalize():yC(t)}else if(t.kind===`pin_in_slot`)n.axis=t.axis2?new X(...t.axis2):yC(n.axis);else if(!Jj.includes(t.kind)){let t=e.into(n.block,e.alongAt(n.rail,n.axis,0)),r=n.rail===0||n.block===0,i=Xj(e,n.block,t)>Xj(e,n.rail,n.axis);(r?n.block===0:i)&&(n={rail:n.block,block:n.rail,axis:t,place:n.blockPlace,blockPlace:n.place})}let{rail:r,block:i}=n,a=e.moments.map(t=>e.into(r,e.worldAt(i,n.blockPlace,t).sub(e.worldAt(r,n.place,t)),t).dot(n.axis)).filter(Number.isFinite);return{...n,low:Math.min(...a,1/0),high:Math.max(...a,-1/0)}}function Xj(e,t,n){let r=e.report.bodies[t].skeleton.map(e=>new X(...e).dot(n));return r.length>0?Math.max(...r)-Math.min(...r):0}function Zj(e=e=>i(`--${e}`)){return{view:e(`view`),outline:e(`outline`),label:e(`label`),bodies:Array.from({length:6},(t,n)=>e(`body-${n}`)),steel:e(`steel`),rod:e(`rod`),ground:e(`ground`),hatch:e(`hatch`),rubber:e(`rubber`),tyre:e(`tyre`),driver:e(`driver`),chosen:e(`chosen`),trace:e(`trace`),former:e(`former`),grid:e(`grid`),gridMain:e(`grid-main`),axes:{x:e(`axis-x`),y:e(`axis-y`),z:e(`axis-z`)},light:{sky:Number(e(`sky`)),earth:e(`earth`),sun:Number(e(`sun`)),shadow:Number(e(`shadow`))},glass:Number(e(`glass`))}}var Qj=.05;function $j(e){let{report:t,vehicle:n}=e,r=t.bodies.map(()=>-1),i=t.bodies.map((t,n)=>t.skeleton.map(t=>e.worldAt(n,new X(...t),0))),a=t.bodies.map(()=>new Set);for(let{body_i:e,body_j:n}of t.joints)e!==0&&n!==0&&(a[e].add(n),a[n].add(e));let o=n&&n.up.clone().cross(n.forward);for(let t=1;t<r.length;t++){let n=o?i.findIndex((n,r)=>r>0&&r<t&&eM(i[t],n,o,Qj*e.size)):-1;if(n>0){r[t]=r[n];continue}let s=[...a[t]].map(e=>r[e]),c=e=>r.filter(t=>t===e).length,l=Array.from({length:6},(e,t)=>t).filter(e=>!s.includes(e));r[t]=l.sort((e,t)=>c(e)-c(t)||e-t)[0]??t%6}return r}function eM(e,t,n,r){let i=e=>e.clone().addScaledVector(n,-2*e.dot(n));return e.length>0&&e.length===t.length&&e.every(e=>t.some(t=>t.distanceTo(i(e))<r))}var tM=64,nM=1e-4,rM=5,iM={ofDistance:.16,least:.0012,most:.0125},aM={least:.75,most:14,step:1.25},oM=1,sM=1.15,cM={ofDistance:.3,least:.35},lM=class{report;base;former;moments;sweep;box;centre;size;unit;plane;up;reader;vehicle;large;carriers;topLayer;#e;#t;#n;#r;#i;constructor(e,t,n){this.report=e,this.base=t,this.former=n;let r=Math.max(0,e.times.length-1),i=Math.max(1,Math.floor(r/tM));this.moments=[...Array.from({length:Math.ceil(r/i)},(e,t)=>t*i),r];let a=e.bodies.map(()=>[]);for(let t of e.joints)a[t.body_i].push(new X(...t.at_i)),a[t.body_j].push(new X(...t.at_j));this.sweep=this.#a(a),this.box=new jf().setFromPoints(this.sweep),this.box.isEmpty()&&this.box.expandByPoint(new X),this.centre=this.box.getCenter(new X),this.size=t?.size??(this.box.getSize(new X).length()||1),this.#t=a.map(e=>this.distinct(e)),this.#e=t?t.#e:this.#s(),this.unit=t?.unit??this.#e,this.plane=t?t.plane:Rj(e,this.sweep,this.size);let{vehicle:o}=e;this.vehicle=o?{forward:new X(...o.forward),up:new X(...o.up)}:void 0,this.up=this.plane&&Math.abs(this.plane.z)>.5?new X(0,1,0):this.vehicle?.up??new X(0,0,1),this.large=e.bodies.length>41,this.carriers=t?t.carriers:uM(e),this.reader=t?t.reader:this.plane||this.vehicle||this.large?Bj:this.#o(),this.#r=t?t.#r:$j(this),this.#n=t?t.#n:this.plane?this.#c():e.bodies.map(()=>0),this.topLayer=Math.max(0,...this.#n),this.#i=e.joints.map(e=>Yj(this,e))}sizeTo(e){let t=this.#e*e;if(!(t>0&&Number.isFinite(t)))return!1;let n=e=>Math.log(e/t)/Math.log(aM.step),r=Math.max(0,Math.ceil(n(aM.least)))+Math.min(0,Math.floor(n(aM.most))),i=this.#e*aM.step**r,a=i!==this.unit;return this.unit=i,a}layerOf(e){return this.#n[e]}colourOf(e){return this.#r[e]}get thickness(){return oM*this.unit}get pitch(){return sM*this.unit}lift(e,t=this.#n[e]){return this.plane?this.into(e,this.plane).multiplyScalar(t*this.pitch):new X}placesOf(e){return this.#t[e]}slideOf(e){return this.#i[e]}jointsOf(e){return this.report.joints.flatMap((t,n)=>{if(t.body_i!==e&&t.body_j!==e)return[];let r=t.body_i===e,i=r?t.axis:t.axis_j??void 0;return[{joint:t,index:n,at:new X(...r?t.at_i:t.at_j),axis:i?new X(...i):void 0}]})}shapePoints(e){let{skeleton:t,roles:n}=this.report.bodies[e],r=e=>new X(...t[e]),i=t.map((e,t)=>t),a=i.filter(e=>n[e]===`joint`||n[e]===`hinge`).map(r),o=this.plane?this.#i.flatMap(t=>t&&t.rail===e&&e>0?dM(t):[]):[],s=this.distinct([...a,...this.#t[e],...o]);return s.length>2?s:this.distinct([...s,...i.filter(e=>n[e]===`measured`).map(r)])}radiusAt(e,t){let n=this.#t[e].filter(e=>!this.same(e,t)).map(e=>e.distanceTo(t));return Math.max(Math.min(this.unit,cM.ofDistance*Math.min(...n,1/0)),cM.least*this.unit)}radiusOf(e){return Math.min(this.radiusAt(e.body_i,new X(...e.at_i)),this.radiusAt(e.body_j,new X(...e.at_j)))}roomOf({body_i:e,body_j:t,at_i:n,at_j:r}){let i=(e,t)=>this.#t[e].filter(e=>!this.same(e,t)).map(e=>e.distanceTo(t));return Math.min(...i(e,new X(...n)),...i(t,new X(...r)),this.size)}poseAt(e,t){return Aj(this.report.bodies[e].poses,t)}worldAt(e,t,n){return Pj(this.poseAt(e,n),t)}alongAt(e,t,n){return Fj(this.poseAt(e,n),t)}into(e,t,n=0){let r=this.poseAt(e,n)?.turn??new ld;return t.clone().applyQuaternion(r.clone().invert())}placeInto(e,t,n=0){let r=this.poseAt(e,n);return r?this.into(e,t.clone().sub(r.place),n):t.clone()}frame(e){let t=this.report.bodies.map((t,n)=>this.poseAt(n,e));return{step:e,at:(e,n)=>Pj(t[e],n),along:(e,n)=>Fj(t[e],n),visible:e=>t[e]!==void 0}}same(e,t){return e.distanceTo(t)<nM*this.size}distinct(e){return e.filter((t,n)=>e.findIndex(e=>this.same(e,t))===n)}#a(e){return this.report.bodies.flatMap(({skeleton:t,roles:n},r)=>{let i=[...t.filter((e,t)=>n[t]!==`wheel`).map(e=>new X(...e)),...e[r]];return(r===0?[0]:this.moments).flatMap(e=>{let t=this.poseAt(r,e);return t?i.map(e=>Pj(t,e)):[]})})}#o(){let{moments:e}=this,t=Array.from({length:rM},(t,n)=>e[Math.floor(n*(e.length-1)/4)]).map(e=>this.distinct(this.#t.flatMap((t,n)=>t.map(t=>this.worldAt(n,t,e))))).filter(e=>e.every(({x:e,y:t,z:n})=>Number.isFinite(e+t+n))),n=this.report.couplers.flatMap(e=>e.kind===`bevel`?JT(new wT(this),e)?.gears??[]:[]);return Gj(t,this.size,n.map(({axis:e})=>e))}#s(){let e=this.#t.slice(1).flatMap((e,t)=>{let n=[...e,...this.report.bodies[t+1].skeleton.map(e=>new X(...e))];return e.flatMap(e=>{let t=n.filter(t=>!this.same(t,e)).map(t=>t.distanceTo(e));return t.length>0?[Math.min(...t)]:[]})});e.sort((e,t)=>e-t);let t=e[Math.floor(e.length/4)]??this.size;return Math.min(Math.max(iM.ofDistance*t,iM.least*this.size),iM.most*this.size)}#c(){let{report:e}=this,t=e.bodies.map(({skeleton:e})=>{let t=e.map(e=>new X(...e));return Math.max(0,...t.flatMap(e=>t.map(t=>e.distanceTo(t))))}),n=e.joints.flatMap(e=>[{at:this.worldAt(e.body_i,new X(...e.at_i),0),bodies:[e.body_i,e.body_j]},{at:this.worldAt(e.body_j,new X(...e.at_j),0),bodies:[e.body_i,e.body_j]}]),r=e=>e.kind===`distance`||e.kind===`leg`,i=Oj(t,n.filter((t,n)=>!r(e.joints[Math.floor(n/2)])),.001*this.size),a=Math.max(0,...i);for(let e of this.carriers)i[e]=a+1;return i}};function uM({couplers:e,joints:t}){let n=e.flatMap(({terms:e})=>{let[n,...r]=e.filter(({turns:e})=>e).map(({joint:e})=>[t[e].body_i,t[e].body_j]);return r.length>0?n.filter(e=>e>0&&r.every(t=>t.includes(e))):[]});return new Set(n)}var dM=({place:e,axis:t,low:n,high:r})=>n<=r?[n,r].map(n=>e.clone().addScaledVector(t,n)):[],fM=6,pM={share:.22,most:110},mM=4,hM=class t{mechanism;look;element=e(`div`,{class:`overview`,"aria-hidden":`true`});#e=new i_;#t;#n;static of(e,n,r){let i=e.up.clone().cross(n.direction).normalize(),[a,o]=[i,e.up].map(t=>gM(e.sweep,t));return e.large&&a>fM*o?new t(e,n,i,o,r):void 0}constructor(e,t,n,r,i){this.mechanism=e,this.look=t,this.#t=n,this.#n=Math.max(r,4*e.unit),this.#e.up.copy(e.up),this.#e.near=.02*e.size,this.#e.far=60*e.size,Object.assign(this.element.style,{position:`absolute`,insetInline:`0`,top:`0`,cursor:`pointer`,borderBottom:`1px solid var(--grid-main)`}),this.element.addEventListener(`pointerdown`,({offsetX:e})=>{i(new X(2*e/this.element.clientWidth-1,0,0).unproject(this.#e))})}strip(e){return Math.round(Math.min(pM.share*e,pM.most))}part(e,t,n){let r=mM*this.#n*n/2,[i,a]=[-1,1].map(t=>t*e.reduce((e,n)=>Math.max(e,t*n.dot(this.#t)),-1/0)),o=Math.max(i+r,Math.min(a-r,t.dot(this.#t))),s=e.filter(e=>Math.abs(e.dot(this.#t)-o)<=r);return s.length>0?s:e}resize(e,t,n){this.element.style.height=`${this.strip(n)}px`,JC(this.#e,e,this.mechanism.size,this.look,t,this.strip(n),0)}draw(e,t,n,r){let i=this.strip(r);e.setViewport(0,r-i,n,i),e.setScissor(0,r-i,n,i),e.setScissorTest(!0),e.clear();for(let n of[0,2])this.#e.layers.set(n),e.render(t,this.#e);e.setScissorTest(!1),e.setViewport(0,0,n,r)}};function gM(e,t){let n=e.map(e=>e.dot(t));return n.reduce((e,t)=>Math.max(e,t),-1/0)-n.reduce((e,t)=>Math.min(e,t),1/0)}var _M=6,vM=4,yM=class{canvas;camera;roots;hover;tip=e(`div`,{class:`tip`,hidden:!0,"data-testid":`tip`});hovered;#e=new E_;#t;#n=!1;constructor(e,t,n,r,i){this.canvas=e,this.camera=t,this.roots=n,this.hover=r,this.#e.layers.enableAll(),this.#e.params.Line2={threshold:_M},e.addEventListener(`pointermove`,e=>this.#r(e)),e.addEventListener(`pointerleave`,()=>this.#a(void 0)),e.addEventListener(`pointerdown`,({offsetX:e,offsetY:t})=>this.#t={x:e,y:t}),e.addEventListener(`pointerup`,({offsetX:e,offsetY:t,button:n})=>{let r=this.#t;this.#t=void 0,n===0&&r&&Math.hypot(e-r.x,t-r.y)<=vM&&i(this.#i(e,t))})}#r(e){if(e.buttons!==0)return this.#a(void 0);if(this.#n)return;this.#n=!0;let{offsetX:t,offsetY:n}=e;requestAnimationFrame(()=>{this.#n=!1,this.#a(this.#i(t,n),t,n)})}#i(e,t){let{clientWidth:n,clientHeight:r}=this.canvas;this.#e.setFromCamera(new Y(2*e/n-1,1-2*t/r),this.camera);let i=this.#e.intersectObjects(this.roots()).filter(({object:e})=>bM(e)&&xM(e)),a=i.find(({object:e})=>!CM(e));return bM((wM(i)??a??i[0])?.object)}#a(t,n=0,r=0){if(t!==this.hovered&&(this.hovered=t,this.hover()),this.tip.hidden=!t,this.canvas.style.cursor=t?`pointer`:``,!t)return;this.tip.replaceChildren(e(`strong`,{},t.name),e(`div`,{},t.about));let{clientWidth:i,clientHeight:a}=this.canvas,[o,s]=[n>i/2,r>a/2];Object.assign(this.tip.style,{left:o?`auto`:`${n+14}px`,right:o?`${i-n+14}px`:`auto`,top:s?`auto`:`${r+10}px`,bottom:s?`${a-r+10}px`:`auto`})}};function bM(e){for(let t=e??null;t;t=t.parent)if(t.userData.part)return t.userData.part}function xM(e){for(let t=e;t;t=t.parent)if(!t.visible)return!1;return!0}var SM=e=>e.material,CM=e=>(SM(e)?.opacity??1)<1,wM=e=>e.find(({object:e})=>SM(e)?.depthTest===!1),TM=1e-6;function EM(e,t){let{report:n,size:r}=e,i=e=>e&&e.poses.length===n.bodies.length?e:void 0,a=i(t.present),o=i(t.former),s=o?new lM(kM(n,o,r),e):e;return a?new lM(kM(n,a,r),e,s):t.changed?new lM(DM(n,t.changes,r),e,s):o?new lM(n,e,s):e}function DM(e,t,n){let r=e.variables.filter(({index:e})=>t[e]),i=e.bodies.map((e,n)=>{let i=OM(r.map(e=>({curve:e.shifts[n],by:t[e.index]})));return i?MM(e.poses,i,1):e.poses}),a=(e,i)=>r.flatMap(({index:r,arrows:a})=>a.filter(t=>t.body===e&&NM(t.at,i)<=TM*n).slice(0,1).map(e=>({arrow:e,by:t[r]}))),o=(e,t)=>a(e,t).reduce((e,{arrow:t,by:n})=>FM(e,t.v,n),t),s=(e,t,n)=>{let r=new X(...n),i=r.clone();for(let{arrow:n,by:o}of a(e,t))i.addScaledVector(new X(...n.turn).cross(r),o);return i.normalize().toArray()},c=AM(e,i,o),l=c.joints.map((t,n)=>{let{body_i:r,body_j:i,at_i:a,at_j:o}=e.joints[n],{axis:c,axis_j:l,hinge:u}=t;return{...t,axis:c&&!u?s(r,a,c):c,axis_j:l&&s(i,o,l)}});return{...c,joints:l}}function OM(e){let t;for(let{curve:n,by:r}of e)if(n&&n.length!==0){t??=new Float32Array(n.length);for(let e=0;e<n.length;e++)t[e]+=r*n[e]}return t}function kM(e,t,n){return AM(e,t.poses,(r,i)=>{let a=e.bodies[r].skeleton.findIndex(e=>NM(e,i)<=TM*n);return t.skeletons[r]?.[a]??i})}function AM(e,t,n){let r=({body:e,at:t})=>({body:e,at:n(e,t)});return{...e,bodies:e.bodies.map((e,r)=>({...e,poses:t[r],skeleton:e.skeleton.map(e=>n(r,e))})),joints:e.joints.map(e=>({...e,at_j:n(e.body_j,e.at_j),...jM(e,n)})),wheels:e.wheels.map(e=>({...e,centre:r(e.centre),kingpin:e.kingpin&&[r(e.kingpin[0]),r(e.kingpin[1])]})),distances:e.distances.map(e=>({...e,from:r(e.from),to:r(e.to)})),drivers:e.drivers.map(e=>({...e,point:e.point&&r(e.point)}))}}function jM({body_i:e,at_i:t,axis:n,hinge:r},i){if(!r)return{at_i:i(e,t),axis:n,hinge:r};let[a,o]=r,[s,c]=[i(e,a),i(e,o)],[l,u]=[PM(o,a),PM(c,s)],d=l.lengthSq();if(d===0||u.lengthSq()===0||!n)return{at_i:i(e,t),axis:n,hinge:[s,c]};let f=PM(t,a).dot(l)/d,p=Math.sign(l.dot(new X(...n)))||1;return{at_i:FM(s,u.toArray(),f),axis:u.normalize().multiplyScalar(p).toArray(),hinge:[s,c]}}function MM(e,t,n){let r=Float32Array.from(e);for(let i=0;i*7<e.length;i++){let a=Aj(e,i);if(!a)continue;let{place:o,turn:s}=Nj(a,t,i,n);r.set([o.x,o.y,o.z,s.w,s.x,s.y,s.z],i*7)}return r}var NM=(e,t)=>Math.hypot(e[0]-t[0],e[1]-t[1],e[2]-t[2]),PM=(e,t)=>new X(e[0]-t[0],e[1]-t[1],e[2]-t[2]),FM=(e,t,n)=>[e[0]+n*t[0],e[1]+n*t[1],e[2]+n*t[2]],IM=28,LM=8,RM=28,zM=.99,BM=class{element=r(`svg`,{class:`triad`,viewBox:`-45 -45 90 90`,"aria-hidden":`true`});#e;constructor(e){this.#e=VM(e).map((e,t)=>{let n=r(`line`,{x1:0,y1:0}),i=r(`text`);return i.textContent=e.name,this.element.append(r(`g`,{class:`axis-${`xyz`[t]}`},n,i)),{...e,line:n,text:i}}),this.element.style.overflow=`visible`,e&&(this.element.style.left=`${RM}px`)}update(e){let t=e.quaternion.clone().invert();for(let{unit:e,name:n,line:r,text:i}of this.#e){let a=e.clone().applyQuaternion(t);r.setAttribute(`x2`,String(a.x*IM)),r.setAttribute(`y2`,String(-a.y*IM));let o=n.length>1;i.setAttribute(`x`,String(a.x*(IM+(o?3:LM)))),i.setAttribute(`y`,String(-a.y*36)),i.style.textAnchor=o&&Math.abs(a.x)>.4?a.x>0?`start`:`end`:`middle`,i.style.opacity=Math.hypot(a.x,a.y)<.15?`0`:`1`}}};function VM(e){let t=e?[{unit:e.forward.clone(),name:`front`},{unit:e.up.clone().cross(e.forward),name:`left`},{unit:e.up.clone(),name:`up`}]:[];return[`x`,`y`,`z`].map((e,n)=>{let r=new X().setComponent(n,1);return t.find(e=>Math.abs(e.unit.dot(r))>zM)??{unit:r,name:e}})}var HM=2,UM=32768;function WM(){let e=document.createElement(`canvas`).getContext(`webgl2`);return e?.getExtension(`WEBGL_lose_context`)?.loseContext(),e!==null}var GM=class{state;element;canvas;looks;scene=new gf;camera;today;#e=new Zb({antialias:!0,preserveDrawingBuffer:!0});#t=new IC;#n;#r;#i;#a=new Cj;#o=e(`canvas`,{class:`paper`});#s=e(`span`);#c=e(`span`,{"data-testid":`arrows`});#l=e(`p`,{class:`message`,hidden:!0},`The graphics were lost; the view comes back when the browser gives them back.`);#u=Zj();#d;#f;#p;#m;#h;#g;#_=!1;#v=!1;#y=!0;#b=!1;#x={width:0,height:0};#S=[];constructor(t){this.state=t,this.today=new lM(t.report),this.#i=new BM(this.today.vehicle),this.looks=GC(this.today),this.#g=this.looks[0],this.camera=qC(this.today),this.canvas=this.#e.domElement,this.canvas.setAttribute(`data-testid`,`view-canvas`),this.canvas.setAttribute(`role`,`img`),this.canvas.setAttribute(`aria-label`,`3D view of ${t.report.title}`),this.#e.autoClear=!1,this.#e.shadowMap.enabled=this.today.plane===void 0,this.#e.shadowMap.type=1,this.#e.shadowMap.autoUpdate=!1,this.#n=new cx(this.camera,this.canvas),this.#n.addEventListener(`change`,()=>this.#F()),this.#n.addEventListener(`start`,()=>this.#_=!0),this.#r=new yM(this.canvas,this.camera,()=>[...this.#f.groups,...this.#d.groups],()=>this.#N(),e=>t.choose({selected:e})),this.element=e(`div`,{class:`view`},this.canvas,this.#a.element,this.#o,this.#l,this.#r.tip,e(`span`,{class:`scale`},this.#c,this.#s)),this.element.append(this.#i.element),this.#m=hM.of(this.today,this.#g,e=>this.#T(e)),this.#m&&this.element.append(this.#m.element),this.#h=KM(t),this.#d=this.#E(),this.#f=this.#D(),this.#p=this.#O(),this.#N(),t.onTime(()=>this.#P());let n=()=>{this.#v=!0,this.#F()};t.onChoice(n),t.onPoint(n),a(()=>this.#k()),addEventListener(`beforeprint`,()=>this.#z()),new ResizeObserver(([{contentRect:e}])=>{this.#x={width:Math.round(e.width),height:Math.round(e.height)},this.#B()}).observe(this.element),this.canvas.addEventListener(`webglcontextlost`,()=>this.#l.hidden=!1),this.canvas.addEventListener(`webglcontextrestored`,()=>{this.#l.hidden=!0,this.#P()})}get mechanism(){return this.#d.mechanism}get assembly(){return this.#d}look(e){this.#g=this.looks.find(t=>t.name===e)??this.looks[0],this.fit()}fit(){let{width:e,height:t}=this.#x;e!==0&&t!==0&&(this.#M(),this.#C(e,t),this.#j(t)&&this.#C(e,t),this.#_=!1,this.#F())}#C(e,t){let n=HM*this.today.unit,r=[0,1,2].flatMap(e=>[-n,n].map(t=>new X().setComponent(e,t))),i=[...(this.mechanism===this.today?this.today.sweep:[...this.today.sweep,...this.mechanism.sweep]).flatMap(e=>r.map(t=>e.clone().add(t))),...this.#d.reach,...this.#f.reach];this.#m?.resize(i,e,t);let a=this.#m?.part(i,this.#w(),e/t)??i;this.#n.target.copy(JC(this.camera,a,this.today.size,this.#g,e,t,this.#m?.strip(t))),this.#n.update()}vectors(){let{width:e,height:t}=this.#x,{view:n,ground:r,outline:i,label:a}=this.#u,o=[...this.#d.groups,...this.#f.groups],s=this.state.report.title;return KS(o,this.camera,{width:e,height:t,title:s,view:n,ground:r,outline:i,label:a,labels:this.#a.placed})}motion(){return iS(this.mechanism,this.#d.drawn,this.state.step)}#w(){let{selected:e,variable:t}=this.state.choice,{report:n,sweep:r}=this.today,i=e?.kind===`joint`?n.joints[e.index]:void 0,a=n.variables[t]?.arrows[0];return e?.kind===`body`&&e.index>0?this.today.worldAt(e.index,this.today.shapePoints(e.index)[0]??new X,0):i?this.today.worldAt(i.body_i,new X(...i.at_i),0):a?this.today.worldAt(a.body,new X(...a.at),0):r[0]??new X}#T(e){let t=new X().setFromMatrixColumn(this.camera.matrixWorld,0),n=t.multiplyScalar(e.clone().sub(this.#n.target).dot(t));this.#n.target.add(n),this.camera.position.add(n),this.#_=!0,this.#n.update(),this.#F()}async picture(e){let t=this.#e.getPixelRatio();this.#V(e),this.#I();let n=await new Promise(e=>this.canvas.toBlob(e,`image/png`));if(this.#V(t),this.#I(),!n)throw Error(`the browser gave no picture of the view`);return n}#E(){let e=new zC(EM(this.today,this.state),this.#u,this.state.choice,$A,this.#t,0);return this.scene.add(...e.groups),e}#D(){let e=this.today.report.variables[this.state.choice.variable],t=e&&RE(this.today,e);this.#c.textContent=t===void 0?``:`arrows for ${zE(t,e)}, `;let n=new zC(this.#d.mechanism,this.#u,this.state.choice,ej,this.#t,UM);return this.scene.add(...n.groups),n}#O(){let{up:e,report:t}=this.today,n=[...this.#d.reach,...this.today.sweep].map(t=>t.dot(e)),r=new oj(this.today,this.#u,n.length>0?n.reduce((e,t)=>Math.min(e,t)):0);return this.scene.add(r.object),this.#s.textContent=`${t.wheels.length>0?`road, `:``}grid ${s(r.cell)} ${t.units.length}`,this.#t.colour(this.#u),this.#e.setClearColor(this.#u.view),r}#k(){this.#u=Zj(),this.#A(),this.#p.object.removeFromParent(),this.#p.dispose(),this.#p=this.#O(),this.#I()}#A(){for(let e of[this.#d,this.#f])this.#L(e);this.#d=this.#E(),this.#f=this.#D(),this.#N(),this.#y=!0}#j(e){let t=this.today.sizeTo(YC(this.camera,this.#n.target,e));return t&&this.#A(),t}#M(){if(!this.#v)return;this.#v=!1;let e=KM(this.state);e!==this.#h&&(this.#h=e,this.#L(this.#d),this.#d=this.#E()),this.#L(this.#f),this.#f=this.#D(),this.#y=!0,this.#N()}#N(){let{selected:e}=this.state.choice,t=t=>tj(t,e)?`chosen`:tj(t,this.#r.hovered)?`hovered`:`none`,n=[...this.#d.numbers,...this.#f.numbers];this.#t.emphasise(new Map(n.map(({part:e,number:n})=>[n,t(e)]).filter(([,e])=>e!==`none`))),this.#F()}#P(){this.#y=!0,this.#F()}#F(){this.#b||(this.#b=!0,requestAnimationFrame(()=>{this.#b=!1,this.#I()}))}#I(){let{width:e,height:t}=this.#x;if(e===0||t===0)return;if(this.#M(),this.#j(t),this.#y){let e=this.mechanism.frame(this.state.step);this.#d.pose(e),this.#f.pose(e),this.#e.shadowMap.needsUpdate=!0,this.#y=!1}this.#d.refine(YC(this.camera,this.#n.target,t))&&(this.#e.shadowMap.needsUpdate=!0);let{layers:n}=this.camera;n.set(0),this.#e.clear(),this.#e.render(this.scene,this.camera),this.#t.draw(this.#e,this.scene,this.camera),n.set(2),this.#e.render(this.scene,this.camera),n.set(0),this.#m?.draw(this.#e,this.scene,e,t);for(let e of this.#S.splice(0))e.dispose();this.#i.update(this.camera),this.#R()}#L(e){for(let t of e.groups)t.removeFromParent();this.#S.push(e)}#R(){let{width:e,height:t}=this.#x,n=this.mechanism.frame(this.state.step),{selected:r}=this.state.choice,{hovered:i}=this.#r,a=[r,tj(r,i)?void 0:i].filter(e=>e!==void 0),o=this.state.choice.labels?wj(this.mechanism,n):a.flatMap(e=>Ej(this.mechanism,n,e));o.unshift(...Tj(this.mechanism,n,this.state.choice.distance,e=>k(this.state.curve(e,0),this.state.step))),this.#a.show(o,this.camera,this.mechanism.centre,e,t)}#z(){this.#o.width=this.canvas.width,this.#o.height=this.canvas.height,this.#o.getContext(`2d`).drawImage(this.canvas,0,0)}#B(){let{width:e,height:t}=this.#x;e!==0&&t!==0&&(this.#V(Math.min(devicePixelRatio,2)),this.#_?XC(this.camera,e/t):this.fit(),this.#I())}#V(e){let{width:t,height:n}=this.#x;this.#e.setPixelRatio(e),this.#e.setSize(t,n,!1),this.#t.resize(t,n,e)}};function KM({changes:e,choice:t}){return JSON.stringify([e,t.compared])}function qM(t){if(!WM())return{element:e(`div`,{class:`view`,"data-testid":`no-webgl`},e(`p`,{class:`message`},`This browser offers no WebGL, so the 3D view is left out. Curves and tables are complete.`))};let n=new GM(t),r=n.looks.map(({name:t,title:n},r)=>e(`button`,{type:`button`,title:n,"data-testid":`look-${t}`,onclick:()=>i(r)},t)),i=e=>{let t=n.looks[e];t&&(n.look(t.name),r.forEach((t,n)=>t.setAttribute(`aria-pressed`,String(n===e))))};r.forEach((e,t)=>e.setAttribute(`aria-pressed`,String(t===0)));let a=e(`button`,{type:`button`,title:`Names of hardpoints (L)`,"data-testid":`labels`,onclick:()=>t.choose({labels:!t.choice.labels})},`labels`),o=()=>a.setAttribute(`aria-pressed`,String(t.choice.labels));t.onChoice(o),o();let s=e(`button`,{type:`button`,title:`Fit (F)`,"data-testid":`fit`,onclick:()=>n.fit()},`fit`);return n.element.append(e(`div`,{class:`looks`,role:`toolbar`,"aria-label":`Standard views`},...r,s,a,YM(t)),JM(t)),{element:n.element,view:n,look:i}}function JM(t){let n=e(`span`),r=e(`p`,{class:`ghost-key`},e(`span`,{class:`swatch dashed`,style:`--swatch: var(--former)`}),n),i=()=>{r.hidden=!t.compares,n.textContent=`${t.former?.name??`as loaded`}${t.foreseen?`; solid: foreseen to first order`:``}`};return t.onChoice(i),i(),r}function YM(t){let n=e(`select`,{"data-testid":`trace`,"aria-label":`Path of a hardpoint`,title:`Path of a hardpoint`,onchange:()=>{let[e,r]=n.value.split(` `).map(Number);t.choose({trace:n.value?[e,r]:void 0})}},e(`option`,{value:``},`no path`),...t.report.bodies.slice(1).map((t,n)=>e(`optgroup`,{label:t.name},...t.labels.map((t,r)=>e(`option`,{value:`${n+1} ${r}`},`path of ${t}`)))));return n}function XM(t,n){let r=n.map(({name:t,title:i},o)=>e(`button`,{type:`button`,role:`tab`,id:`tab-${t}`,"aria-controls":`panel-${t}`,"data-testid":`tab-${t}`,onclick:()=>a(o),onkeydown:e=>{let t={ArrowRight:1,ArrowLeft:-1}[e.key];if(!t)return;let i=(o+t+n.length)%n.length;a(i),r[i].focus()}},i)),i=n.map(({name:t,content:n})=>e(`div`,{role:`tabpanel`,id:`panel-${t}`,"aria-labelledby":`tab-${t}`,class:`panel`,tabindex:0},n)),a=e=>{r.forEach((t,n)=>{t.setAttribute(`aria-selected`,String(n===e)),t.tabIndex=n===e?0:-1}),i.forEach((t,n)=>t.classList.toggle(`away`,n!==e))};return a(0),e(`section`,{class:`tabs`,"aria-label":t},e(`div`,{role:`tablist`,"aria-label":t},...r),...i)}var ZM=6,QM=`M2 1v10l9-5z`,$M=`M2 1h3v10h-3zM7 1h3v10h-3z`;function eN(t){let{report:n}=t,i=l(n.units.time),a=t.lastStep===0,o=e(`button`,{type:`button`,class:`play`,"data-testid":`play`,disabled:a,onclick:()=>t.toggle()}),c=e(`input`,{type:`range`,min:0,max:t.lastStep,step:1,disabled:a,"aria-label":`time`,"data-testid":`scrub`,oninput:()=>{t.pause(),t.goToStep(Number(c.value))}}),u=e(`output`,{class:`readout`,"data-testid":`time`}),d=n.times[t.lastStep]-n.times[0],p=d>0?Math.min(1,f(d/ZM)):1;t.speed=p;let m=e(`select`,{"aria-label":`playback speed`,"data-testid":`speed`,onchange:()=>t.speed=Number(m.value)},...[.1,.2,.5,1,2,5].map(e=>Number((p*e).toPrecision(3))).map(t=>e(`option`,{value:t,selected:t===p},`${s(t)}×`))),h=()=>{o.replaceChildren(r(`svg`,{viewBox:`0 0 12 12`,"aria-hidden":`true`},r(`path`,{d:t.playing?$M:QM}))),o.setAttribute(`aria-label`,t.playing?`pause`:`play`),c.value=String(Math.round(t.step));let e=`${s(t.time,4)} ${i}`;c.setAttribute(`aria-valuetext`,e),u.textContent=e};return t.onTime(h),h(),e(`div`,{class:`transport`,role:`group`,"aria-label":`Time`},o,c,u,m)}var tN=.08,nN=.2;function rN(e,{arrows:t,bounds:n,typical:r,tolerance:i}){let a=Math.max(0,...t.map(({v:e})=>Math.hypot(...e))),o=Math.max(0,...t.map(({turn:e})=>Math.hypot(...e))),s=Math.min(a>0?tN*iN(e)/a:1/0,o>0?nN/o:1/0),c=Number.isFinite(s)?f(s):Math.max(10*(r??0),10*(i??0));return[n?.[0]??-c,n?.[1]??c]}function iN({bodies:e}){let t=0;for(let n=0;n<3;n++){let r=e.flatMap(({skeleton:e,poses:t})=>e.map(e=>e[n]+(t[n]||0)));r.length>0&&(t+=r.reduce((e,t)=>[Math.min(e[0],t),Math.max(e[1],t)],[1/0,-1/0]).reduce((e,t)=>t-e)**2)}return Math.sqrt(t)}var aN=12;function oN(n){let{report:r,choice:i}=n,a=e(`ul`,{"aria-label":`Design variables`}),o=e(`span`,{class:`muted`}),s=e(`button`,{type:`button`,class:`plain`,"data-testid":`reset-all`,onclick:()=>n.reset()},`reset all`),c=e(`input`,{type:`search`,placeholder:`find a variable`,"aria-label":`Find a variable`,"data-testid":`variable-search`,oninput:()=>f()});c.hidden=r.variables.length<=aN;let l=e(`p`,{class:`note`,"data-testid":`variable-note`,"aria-live":`polite`}),u=r.variables.map(e=>sN(n,e)),d=u,f=()=>{let e=c.value.trim().toLowerCase();for(let{variable:t,element:n}of u)n.hidden=e!==``&&!`${t.name} ${t.description}`.toLowerCase().includes(e)},p=``,m=()=>{let e=`${i.quantity} ${i.order}`;if(e===p)return;p=e;let t=r.quantities[i.quantity],n=t?Hs(r,i.quantity,i.order):[];o.textContent=t?`by effect on ${ie(t,i.order)}`:``;let s=new Map(n.map(({variable:e},t)=>[e.index,t]));for(let e of u){let r=n[s.get(e.variable.index)??-1];e.rank(r,t?L(t,i.order,e.variable):``)}let c=({variable:e})=>s.get(e.index)??u.length+Number(e.admissibility===`cannot_follow`);d=[...u].sort((e,t)=>c(e)-c(t)||e.variable.index-t.variable.index),a.replaceChildren(...d.map(({element:e})=>e)),a.scrollTop=0},h=-1,g=()=>{m();for(let e of u)e.sync();s.hidden=!n.changed;let e=r.variables[i.variable],o=n.foreseen?`Changes are foreseen to first order. `:``;if(l.replaceChildren(...t(o+(e?.note||e?.description||``))),i.variable===h)return;h=i.variable;let{element:c}=u[h];(c.offsetTop<a.scrollTop||c.offsetTop+c.offsetHeight>a.scrollTop+a.clientHeight)&&(a.scrollTop=c.offsetTop-a.clientHeight/3)};return a.addEventListener(`keydown`,e=>{let t={ArrowDown:1,ArrowUp:-1}[e.key];if(!t||e.target.closest(`input`))return;e.preventDefault();let r=d.filter(({element:e})=>!e.hidden),a=r[r.findIndex(({variable:e})=>e.index===i.variable)+t];a&&(n.choose({variable:a.variable.index}),a.focus())}),n.onChoice(g),g(),e(`section`,{class:`variables`,"aria-label":`Variables`,"data-testid":`variables`},e(`div`,{class:`head`},e(`h2`,{},`Variables`),o,c,s),a,l)}function sN(n,r){let{index:i,name:a,unit:o,admissibility:u}=r,d=u!==`cannot_follow`,[p,m]=d?rN(n.report,r):[0,0],h=m>p?f((m-p)/100):0,g,_=e=>{g===void 0&&requestAnimationFrame(()=>{let e=g;g=void 0,n.change(i,e)}),g=e},v=e(`button`,{type:`button`,class:`name`,name:a,title:r.description||a,onclick:()=>n.choose({variable:i})},a),y=e(`input`,{type:`range`,min:p,max:m,step:h,value:0,"data-testid":`change`,"aria-label":`change of ${a}`,oninput:()=>_(Number(y.value))}),b=e(`input`,{type:`number`,step:h,value:0,"data-testid":`change-value`,"aria-label":`change of ${a} in ${l(o)||`its unit`}`,onchange:()=>n.change(i,cN(Number(b.value),r))}),x=e(`button`,{type:`button`,class:`icon`,title:`reset ${a}`,"aria-label":`reset ${a}`,"data-testid":`reset`,onclick:()=>n.change(i,0)},`↺`),S=e(`span`,{class:`bar-of`,"aria-hidden":`true`}),C=e(`span`,{class:`size`}),w=e(`span`,{class:`effect`,"data-testid":`effect`},S,C),T=h>0?[y,e(`span`,{class:`amount`},b,e(`span`,{class:`unit`},l(o)))]:[],E=e(`li`,{class:`${u} ${T.length>0?``:`fixed`}`,"data-testid":`variable-${a}`},e(`span`,{class:`who`},v,d?W(r):void 0),...T,d?w:e(`span`,{class:`why`,title:r.note},...t(r.note||`the mechanism cannot follow`)),T.length>0&&x);E.addEventListener(`pointerdown`,e=>{!e.target.closest(`button`)&&n.choice.variable!==i&&n.choose({variable:i})});let D=``,O=h>0?Math.max(0,-Math.floor(Math.log10(h))):0;return{variable:r,element:E,sync:()=>{let e=n.choice.variable===i,t=n.changes[i],r=()=>`${e} ${t} ${b.value}`;D!==r()&&(E.setAttribute(`aria-current`,String(e)),v.tabIndex=e?0:-1,y.tabIndex=b.tabIndex=x.tabIndex=e?0:-1,Number(y.value)!==t&&(y.value=String(t)),(document.activeElement!==b||Number(b.value)!==t)&&(b.value=String(Number(t.toFixed(Math.max(O,3))))),y.setAttribute(`aria-valuetext`,c(t,o)),x.classList.toggle(`away`,t===0),E.classList.toggle(`changed`,t!==0),D=r())},rank:(e,t)=>{S.style.setProperty(`--share`,String(e?.share??0)),S.classList.toggle(`negative`,(e?.extreme??0)<0);let n=(e?.extreme??0)>0?`+`:``;C.textContent=e?e.share===0?`≈ 0`:`${n}${s(e.extreme,3)} ${t}`:`not known`},focus:()=>v.focus()}}function cN(e,{bounds:t}){return Number.isFinite(e)?Math.min(Math.max(e,t?.[0]??-1/0),t?.[1]??1/0):0}function lN(t,n){let{report:r}=n,i=r.quantities.length>0,a=r.variables.length>0,o=i?Bc(n):void 0,s=Uc(),c=qM(n),l=i?new rc(n):void 0,u=i&&a?[{name:`table`,title:`Table`,content:e(`div`,{class:`influence`},Ce(n),H(n))}]:[],d=r.maps.length>0?[{name:`maps`,title:`Maps`,content:e(`div`,{},...r.maps.map(e=>xt(e,r.quantities[n.choice.quantity]?.name??``)))}]:[],f=r.sweep?[{name:`designs`,title:r.sweep.what===`design`?`Designs`:`Residuals`,content:Ft(r.sweep)}]:[],p=[[`variables`,a?oN(n):void 0],[`curves`,l?.element],[`tables`,XM(`Tables and checks`,[...f,...d,...u,{name:`checks`,title:`Checks`,content:zs(n)}])]].flatMap(([e,t])=>t?[{name:e,element:t}]:[]);for(let{name:e,element:t}of p)t.classList.add(`area-${e}`);t.classList.toggle(`no-variables`,!a),t.classList.toggle(`no-curves`,!i),t.append(Vt(n,{find:o?.element,exports:()=>Ic(n,l?.figures??[],c.view),help:()=>s.showModal()}),...r.status.complete?[]:[uN(r)],...r.values.length>0?[Kt(n)]:[],e(`div`,{class:`scene`},c.element,eN(n)),...p.map(({element:e})=>e),Kc(p.map(({name:e,element:t})=>({name:e,element:t})),()=>s.showModal()),s),Wc(n,{fit:c.view&&(()=>c.view?.fit()),look:c.look,find:o?.focus,help:()=>s.showModal()})}function uN({status:n}){return e(`p`,{class:`banner`,role:`status`,"data-testid":`banner`},e(`strong`,{},`This motion is incomplete. `),...t(n.message))}var dN=class{report;choice;changes;step=0;playing=!1;speed=1;#e=[];#t=[];#n=[];#r;constructor(e){this.report=e;let t=Us(e),n=Hs(e,t,0)[0]?.variable.index??e.variables.find(({sensitivities:e})=>e.size>0)?.index??0,r=e.designs.find(({kind:e})=>e===`exact`);this.changes=e.variables.map((e,t)=>r?.change[t]??0),this.choice={quantity:t,variable:n,order:0,over:e.over??void 0,labels:!1}}get lastStep(){return Math.max(0,this.report.times.length-1)}get time(){return k(this.report.times,this.step)}get present(){return this.report.designs.find(({kind:e,change:t})=>e===`exact`&&this.changes.every((e,n)=>e===(t[n]??0)))}get former(){return this.choice.compared===void 0?void 0:this.report.designs[this.choice.compared]}get compares(){return this.former?this.former!==this.present:this.present!==void 0||this.changed}get changed(){return this.changes.some(e=>e!==0)}get foreseen(){return this.changed&&!this.present}curve(e,t){let n=this.report.quantities[e].curves[t],{present:r}=this;if(r)return r.quantities[e]?.[t]??new Float32Array;if(!this.changed)return n;let i=n.slice();for(let{index:n,sensitivities:r}of this.report.variables){let a=this.changes[n],o=r.get(e)?.curves[t];if(a!==0&&o)for(let e=0;e<i.length;e++)i[e]+=a*(o[e]??NaN)}return i}value(e){let{value:t,sensitivities:n}=this.report.values[e],{present:r}=this;return r?r.values[e]??null:t===null?null:this.changes.reduce((e,t,r)=>t===0?e:e===null||n[r]==null?null:e+t*n[r],t)}onChoice(e){this.#e.push(e)}onTime(e){this.#t.push(e)}onPoint(e){this.#n.push(e)}point(e){let t=this.choice.distance;if(this.#r=e,this.choice.distance=this.#i(),this.choice.distance!==t)for(let e of this.#n)e()}choose(e){Object.assign(this.choice,e),this.choice.distance=this.#i();for(let e of this.#e)e()}#i(){let{quantities:e,distances:t}=this.report;return[this.#r,this.choice.quantity].map(n=>n===void 0?-1:t.findIndex(({name:t})=>t===e[n]?.name)).find(e=>e>=0)}change(e,t){this.changes[e]=t,this.choose({variable:e})}reset(){this.changes.fill(0),this.choose({})}goToStep(e){this.step=Math.min(Math.max(e,0),this.lastStep);for(let e of this.#t)e()}goToTime(e){this.goToStep(A(this.report.times,e))}nudge(e){this.pause(),this.goToStep(Math.round(this.step)+e)}pause(){this.playing&&this.toggle()}toggle(){this.lastStep!==0&&(this.playing=!this.playing,this.playing&&(this.step>=this.lastStep&&(this.step=0),this.#a()),this.goToStep(this.playing?this.step:Math.round(this.step)))}#a(){let e=performance.now(),t=n=>{if(!this.playing)return;let{times:r}=this.report,i=this.time+Math.max(0,n-e)/1e3*this.speed;e=n,i>r[this.lastStep]?this.goToStep(0):this.goToTime(i),requestAnimationFrame(t)};requestAnimationFrame(t)}};async function fN(e){let t=await pN(e),[n,r,i,a]=new Uint32Array(t.buffer,0,mN),o=mN*4+n,s=JSON.parse(new TextDecoder().decode(t.subarray(mN*4,o))),c=new yN(t,o,r,i,a);return{payload:s,decode:e=>vN(e.map(e=>c.track(e)))}}async function pN(e){let t=new Blob([_N(e)]).stream().pipeThrough(new DecompressionStream(`deflate-raw`));return new Uint8Array(await new Response(t).arrayBuffer())}var mN=4,hN=8,gN=16;function _N(e){let t=atob(e.trim()),n=new Uint8Array(t.length);for(let e=0;e<t.length;e++)n[e]=t.charCodeAt(e);return n}function vN(e){if(e.length<2)return e[0]??new Float32Array;let t=new Float32Array(e.length*e[0].length);return e.forEach((n,r)=>n.forEach((n,i)=>t[i*e.length+r]=n)),t}var yN=class{#e;#t;#n;#r;#i;#a;#o=[];#s=new Map;constructor(e,t,n,r,i){let a=t,o=t=>e.slice(a,a+=t);this.#e=o(n),this.#t=new Uint32Array(o(4*n).buffer),this.#n=new Float32Array(o(4*n).buffer),this.#r=new Uint32Array(o(4*n).buffer),this.#i=new Uint32Array(o(8*r).buffer),this.#a=[0,1,2,3].map(()=>e.subarray(a,a+=i));let[s,c]=[0,0];for(let e=0;e<n;e++){this.#o.push({residual:s,gap:c}),this.#e[e]>=hN&&(s+=this.#t[e]);for(let t=c+this.#r[e];c<t;c++)this.#e[e]>=hN&&(s-=this.#i[2*c+1])}}track(e){let t=this.#s.get(e);if(t)return t;let n=this.#c(e);return this.#s.set(e,n),n}#c(e){let t=new Float32Array(this.#t[e]),{gap:n}=this.#o[e],r=this.#l(e),i=[...this.#i.subarray(2*n,2*(n+this.#r[e])),t.length];for(let n=0,a=0,o=0;n<t.length;o+=2){let s=i[o]-n;r?t.set(r.subarray(a,a+s),n):t.fill(this.#n[e],n,n+s),a+=s,n+=s,o+1<i.length&&t.fill(NaN,n,n+=i[o+1])}return t}#l(e){let t=this.#e[e];if(t<hN)return;let{residual:n}=this.#o[e],r=this.#o[e+1]?.residual??this.#a[0].length,[i,a,o,s]=this.#a,c=new Int32Array(r-n);for(let e=n;e<r;e++){let t=i[e]|a[e]<<8|o[e]<<16|s[e]<<24;c[e-n]=t>>>1^-(t&1)}for(let e=t%8;e>0;e--)for(let e=1;e<c.length;e++)c[e]+=c[e-1];if(t<gN){let t=this.#n[e];return Float32Array.from(c,e=>e*t)}return new Float32Array(c.map(e=>e<0?-e|1<<31:e).buffer)}},{payload:bN,decode:xN}=await fN(document.getElementById(`payload`).textContent);lN(document.getElementById(`page`),new dN(N(bN,xN))),requestAnimationFrame(()=>requestAnimationFrame(()=>performance.mark(`ready`)));